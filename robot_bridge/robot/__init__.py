"""The reference robot: how a robot speaks to the bridge, with a simulated body."""
