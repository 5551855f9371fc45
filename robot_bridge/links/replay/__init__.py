"""Recorded drives as robots that are marked as replay, and cannot be commanded."""
