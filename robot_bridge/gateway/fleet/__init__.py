"""The fleet: requests of robots and operators, emergency stop, geofence, observations, outbox."""
