"""What tests of the bridge drive it with: real programs and sockets, and a fleet without either."""
