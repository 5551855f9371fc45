"""ROS 2 robots without a ROS installation: DDS by cyclonedds, messages by rosbags' type system."""
