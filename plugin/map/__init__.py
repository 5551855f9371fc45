"""The map canvas: overlay of live robots, map tools, and layers of what the gateway reports."""
