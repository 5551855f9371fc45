"""What Alembic runs to make the tables and to bring older ones up to date."""
