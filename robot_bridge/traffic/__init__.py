"""Robots on their ways at the same time: where they come too near to one another, and who waits for whom."""
