"""Robots, desks and a gateway that lose database, network, disk or life, and an audit of what is left."""
