"""What `make bench` measures, on the real data beside the project: one module for each part of the page."""
