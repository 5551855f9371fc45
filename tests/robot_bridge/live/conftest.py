"""The tests in this folder run the real programs as processes."""
