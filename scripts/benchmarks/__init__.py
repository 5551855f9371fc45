"""What `make bench` measures, on the real data beside the project."""
