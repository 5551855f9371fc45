"""Model of the fleet, without I/O: robots and their positions, clocks, arrival, commands, queues of tasks."""
