"""Shared parts of the ROS adapters, over any transport: messages, tasks, stops."""
