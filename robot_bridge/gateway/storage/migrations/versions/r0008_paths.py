"""What robots declared in Ready of how they come to targets."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Add the column: without it a robot counts as declaring nothing from a restart to its next Ready."""
    op.add_column("robots", sa.Column("paths", sa.String(16), nullable=True))
