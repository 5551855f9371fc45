"""Map tools: select robots, set targets, draw routes, close roads, read surfaces."""
