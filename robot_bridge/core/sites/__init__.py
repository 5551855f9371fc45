"""A published site: its GeoPackage, its settings, its frame and the maps made from it."""
