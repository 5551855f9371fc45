"""What a demonstration needs around it: processes, a screen, a QGIS profile of its own, a gateway, robots."""
