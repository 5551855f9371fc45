"""What robots saw: shown on the map with its images, and accepted or rejected."""
