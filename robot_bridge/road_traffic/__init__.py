"""Roads and the traffic on them at work: ways found, roads kept closed, robots led round one another."""
