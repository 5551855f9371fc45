"""Control of the fleet: pending command, its validation and sending, requests, messages, FleetController."""
