"""Cones as they were placed, on their way out of the database."""
