"""How long to wait for what must come."""

BUSY = 4.0
"""How many times longer than on an idle machine something may take before it counts as not coming."""

START = 60.0
"""Seconds that one of our programs has until it is ready; one that ends before is noticed at once."""
