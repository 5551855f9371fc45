"""Roads and traffic: paths found, roads closed, conflicts of robots predicted and resolved."""
