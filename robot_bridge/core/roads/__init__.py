"""Road network: centrelines, noding, defects, routes, surfaces, export."""
