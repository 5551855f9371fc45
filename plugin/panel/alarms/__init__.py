"""Alarms: rules on arrays, hysteresis, board of alarms, and what shows them."""
