"""The desk's side of the wire to the gateway, without Qt: what to send, what came, when to try again."""
