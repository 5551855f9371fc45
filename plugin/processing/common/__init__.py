"""Parameters, sources and outputs shared by the algorithms."""
