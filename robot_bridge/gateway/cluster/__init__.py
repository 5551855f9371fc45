"""Several gateways on one fleet: membership, ownership of robots, and messages between them."""
