"""A robot that finds itself on the map that it was sent: sensors, ray casting, particle filter."""
