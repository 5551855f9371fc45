"""What strangers and broken robots send to a gateway."""
