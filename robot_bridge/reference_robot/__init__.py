"""The reference robot: its connection to the gateway, and a simulated body."""
