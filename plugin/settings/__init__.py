"""What QGIS keeps for the plugin between sessions: connections, tokens, preferences."""
