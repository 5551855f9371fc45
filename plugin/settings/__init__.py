"""Connections, tokens and preferences, kept in the QGIS profile."""
