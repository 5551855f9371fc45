"""The guided tour, with a practice fleet of simulated robots."""
