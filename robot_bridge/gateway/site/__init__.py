"""Published site as the gateway serves it: maps, places and coordinates."""
