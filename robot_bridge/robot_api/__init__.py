"""How robots connect: each link turns its wire into requests for the fleet, and the outbox into its wire."""
