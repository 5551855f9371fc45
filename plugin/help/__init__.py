"""The guides in QGIS, beside the part that is asked about."""
