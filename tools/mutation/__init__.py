"""Mutation testing: which changes of what stops robots do quick tests not notice?"""
