"""What runs inside QGIS when a demonstration drives it: QGIS's own Python, the plugin as QGIS loaded it."""
