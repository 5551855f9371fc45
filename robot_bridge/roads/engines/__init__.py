"""Ways to find the cheapest way through a directed graph; all give the same answers."""
