"""Trajectories: which positions are stored, for how long, and how they leave the database."""
