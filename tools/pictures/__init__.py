"""The drawn pictures of docs/images, each by a program: python -m tools.pictures.roads [docs/images]."""
