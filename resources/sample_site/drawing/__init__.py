"""The sample site as a photograph from above, drawn from its plan."""
