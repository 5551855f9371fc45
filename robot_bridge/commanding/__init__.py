"""Commands at work: ordered by operators, stored, followed to their ends."""
