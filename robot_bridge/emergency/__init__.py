"""The emergency stop: in force and noted before it is stored, and what the robots say to it."""
