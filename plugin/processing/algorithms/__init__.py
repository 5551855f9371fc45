"""The algorithms of the provider ``fleet``, by subject."""
