"""Alarms: rules on arrays, hysteresis, the board of alarms, and their display."""
