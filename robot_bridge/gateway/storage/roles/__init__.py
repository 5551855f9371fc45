"""Accounts in the database server: one for each robot, with no more rights than the paper gives it."""
