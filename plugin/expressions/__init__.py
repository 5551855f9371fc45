"""What the plugin adds to QGIS's expressions."""
