"""What robots on ROS share however they are reached: their messages, their tasks, how they are stopped."""
