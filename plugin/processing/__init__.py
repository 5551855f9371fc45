"""The Processing provider ``fleet``."""
