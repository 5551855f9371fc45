"""Assignment of cones to robots: jobs, solver, plans and their changes."""
