"""Accounts in the database server: one for each robot, with only the rights that the paper defines."""
