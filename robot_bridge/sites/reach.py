"""How far around a site it is known what stands there."""

KNOWN_BEYOND = 100.0
"""metres: obstacles are published up to so far outside the site's bounds, for a robot at its edge."""
