"""How long to wait for what must come."""

BUSY = 4.0
"""How many times longer than on an idle machine something may take before it counts as not coming."""
