"""Positions out of ROS bags, gone through from the front: one that is cut off is read up to there."""
