"""Shared parts of all adapters: settings, frames, connection to the gateway, persistent memory."""
