"""Cone layouts: the map tool that places them, their dimensions, checks and layer."""
