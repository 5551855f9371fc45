"""Overlay of the canvas: robots, trails, paths, pending command, labels, painted in pixels."""
