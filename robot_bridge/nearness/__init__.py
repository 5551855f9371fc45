"""People and vehicles that are only seen, near robots or about to be: found, and told to operators."""
