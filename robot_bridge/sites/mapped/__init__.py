"""``site.cache``: what is computed of a site's obstacles, made at publishing and mapped by the gateway."""
