"""Where each of several gateways is reached, which robots are told."""

import sqlalchemy as sa
from alembic import op

revision = "0013"
down_revision = "0012"


def upgrade() -> None:
    """Add the address, null for a gateway that does not say it: those of the version before do not."""
    op.add_column("gateways", sa.Column("address", sa.String(256), nullable=True))


def downgrade() -> None:
    """Take it away."""
    op.drop_column("gateways", "address")
