"""Cone layouts: standard courses, cones from files, placement on a site."""
