"""ROS 2 robots over the rosbridge protocol, version 2, for networks that DDS does not cross."""
