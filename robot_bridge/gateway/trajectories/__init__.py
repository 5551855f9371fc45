"""Trajectories: selection, storage, export and archiving of positions."""
