"""Repositories: one module for the rows of each table or two, called in the database's thread."""
