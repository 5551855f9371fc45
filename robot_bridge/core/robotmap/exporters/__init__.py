"""A robot map as other robots and people read it: Nav2 grids and masks, GeoJSON, GeoPackage, SVG."""
