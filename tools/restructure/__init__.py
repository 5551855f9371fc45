"""Moves, merges and renames modules by a map of paths; imports, and names in texts, follow."""
