"""Adapters for robots that speak something else than this project's protocol, each a process of its own."""
