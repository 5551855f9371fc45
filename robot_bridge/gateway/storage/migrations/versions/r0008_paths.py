"""Robots' declarations in Ready on how they reach targets."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the column: without it a robot has no declaration from a restart to its next Ready."""
    op.add_column("robots", sa.Column("paths", sa.String(16), nullable=True))
