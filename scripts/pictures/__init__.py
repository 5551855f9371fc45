"""The drawn pictures of docs/images, each by a program of its own: python -m pictures.roads [docs/images]."""
