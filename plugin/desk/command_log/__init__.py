"""The log of commands: what was asked of whom, every step of it, and where."""
