"""Queues of tasks: edited by operators, stored, sent task by task."""
