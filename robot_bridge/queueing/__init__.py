"""Robots' queues at work: kept in the database, changed by operators, sent task by task."""
