"""Parameters, sources and outputs that algorithms share."""
