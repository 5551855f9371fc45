"""The algorithms of the provider ``fleet``, a module each."""
