"""What operators are warned of: rules on arrays, the alarms that come of them, and what shows these."""
