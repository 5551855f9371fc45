"""Recorded drives out of files: CSV, GPX, our own trajectories and ROS bags, in one form."""
