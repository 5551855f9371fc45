"""Cone plans: submitted by operators, driven through the robots' queues, planned again for what is left."""
