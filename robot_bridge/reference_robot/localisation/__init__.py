"""Localisation on the robot's own map: sensors, ray casting, particle filter, experiments."""
