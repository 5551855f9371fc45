"""QGIS for half an hour with a crowd of robots: what the operator does, and what is watched meanwhile."""
