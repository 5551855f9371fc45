"""Observations of robots: list, layer, images and review."""
