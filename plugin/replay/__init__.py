"""Replay of stored positions and commands."""
