"""The algorithms of the provider ``fleet``, by what they are about."""
