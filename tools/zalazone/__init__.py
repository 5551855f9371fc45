"""`make demo PARTS=zalazone`: the real proving ground, recorded cars, ROS 2 robots, cones in three CRSs."""
