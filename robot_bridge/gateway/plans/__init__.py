"""Cone plans: submitted by operators, driven through the robots' queues, replanned for the rest."""
