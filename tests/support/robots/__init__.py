"""Robots that are not this project's, and how they are had: nodes of ROS 2, rosbridge, AMCL."""
