"""The gateway between operators and robots: a server on WebSocket and SQL."""
