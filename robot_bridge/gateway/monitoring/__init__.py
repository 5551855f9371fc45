"""Monitoring of the gateway: counters, metrics, periodic tasks, garbage collection."""
