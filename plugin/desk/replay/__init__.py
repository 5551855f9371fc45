"""What was: stored positions and commands, played beside the live map."""
