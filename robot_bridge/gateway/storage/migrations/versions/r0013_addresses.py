"""Addresses of several gateways, as sent to robots."""

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"


def upgrade() -> None:
    """Add the address, null for a gateway that does not give it, such as one of the previous version."""
    op.add_column("gateways", sa.Column("address", sa.String(256), nullable=True))


def downgrade() -> None:
    """Drop the column."""
    op.drop_column("gateways", "address")
