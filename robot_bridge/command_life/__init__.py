"""What becomes of a command: its states, when it has reached, what it does to others; no I/O."""
