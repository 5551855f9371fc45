"""What plugin, gateway, links and robots share; no more than the standard library is needed to import it."""
