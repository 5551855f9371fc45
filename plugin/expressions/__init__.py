"""Expression functions for QGIS, and the snapshot of the robots that they read."""
