"""Queues of tasks: what is in them, how they are changed, and what becomes of a task; no I/O."""
