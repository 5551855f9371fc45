"""Many gateways, one fleet: who lives, who has which robot, and what they tell each other."""
