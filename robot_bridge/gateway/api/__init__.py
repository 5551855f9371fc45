"""Interfaces of the gateway: operators, robots on WebSocket and SQL, links, HTTP pages."""
