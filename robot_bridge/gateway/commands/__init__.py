"""Commands: validated, stored, delivered, and followed to their ends."""
