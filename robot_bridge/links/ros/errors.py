"""Errors of a ROS network, its messages and settings."""


class RosError(Exception):
    """An error in an adapter of ROS robots; the text names the fault, its place, and advice."""


class RosNameError(RosError):
    """A name of a topic, a type or a pattern that ROS 2 does not allow."""


class FaultError(RosError):
    """A message of one robot that cannot be used; the others continue."""
