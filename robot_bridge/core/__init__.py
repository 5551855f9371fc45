"""What plugin, gateway, links and robots share; no more than numpy is needed to import it."""
