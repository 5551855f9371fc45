"""The part of Fleet Supervisor that runs inside QGIS."""
