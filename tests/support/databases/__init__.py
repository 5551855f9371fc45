"""Real database servers of the tests' own, and databases on them."""
