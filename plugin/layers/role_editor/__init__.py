"""The dialog Layer roles, with its live preview."""
