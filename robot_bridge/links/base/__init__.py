"""What all adapters share: settings, frames, the connection to the gateway, and what outlives a restart."""
