"""Backups: what a database holds in one file, and back."""
