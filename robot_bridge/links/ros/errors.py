"""What can be wrong with a ROS network, its messages and the settings that name it."""


class RosError(Exception):
    """What an adapter of ROS robots refuses; the text names what was wrong, where, and what to do."""


class RosNameError(RosError):
    """A name of a topic, a type or a pattern that ROS 2 does not allow."""


class FaultError(RosError):
    """A message of one robot that cannot be used; the others go on."""
