"""The groups of the command line, one file each; :mod:`robot_bridge.__main__` puts them together."""
