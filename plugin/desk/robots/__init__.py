"""The table of robots, and all that is known of one of them."""
