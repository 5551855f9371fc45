"""Robots that wait for others on a path of their queue: the task that continues afterwards."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Add the column."""
    op.add_column("holds", sa.Column("task", sa.String(64), nullable=True))
