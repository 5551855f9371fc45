"""Project layers: their roles, their features read into arrays, publication of a site."""
