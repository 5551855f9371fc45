"""Exports of robot maps: Nav2 grids and masks, GeoJSON, GeoPackage, SVG."""
