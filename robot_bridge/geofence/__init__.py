"""The geofence: robots in keepouts and at obstacles are found, told of, and stopped if the site says so."""
