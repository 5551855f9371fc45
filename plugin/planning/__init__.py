"""Cone plans: settings, proposal, editing, execution, and the as-placed report."""
