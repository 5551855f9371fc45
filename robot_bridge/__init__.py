"""The robot bridge: robot maps, the gateway between operators and robots, the reference robot."""
