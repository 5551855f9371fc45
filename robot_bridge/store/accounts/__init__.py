"""Accounts in the database server: one for each robot, which may do what the paper says and no more."""
