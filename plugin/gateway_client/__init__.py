"""Client of the gateway: connection thread, protocol, requests, and the state that the gateway reports."""
