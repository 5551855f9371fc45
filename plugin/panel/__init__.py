"""The Fleet panel: connection, robots, pending command, queue, conflicts, command log, alarms."""
