"""What the plugin adds to QGIS's locator bar."""
