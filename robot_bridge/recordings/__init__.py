"""Recorded drives from files: CSV, GPX, our own trajectories and ROS bags, in a common form."""
