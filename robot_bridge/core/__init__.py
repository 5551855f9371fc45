"""Code shared by plugin, gateway, links and robots; importing it needs no package but numpy."""
