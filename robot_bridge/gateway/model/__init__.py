"""Model of the fleet, without I/O: robots, clocks, arrival, states of commands, queues of tasks."""
