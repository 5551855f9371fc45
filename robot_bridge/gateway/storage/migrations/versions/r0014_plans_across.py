"""What a plan of what is left was asked for, and what speaks against it: any gateway goes on with it."""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"


def upgrade() -> None:
    """Add the columns; of a proposal that is stored nobody knows what speaks against it."""
    op.add_column("plans", sa.Column("try_again", sa.SmallInteger, nullable=False, server_default="0"))
    op.add_column("plans", sa.Column("meetings", sa.Integer, nullable=True))
    op.add_column("plans", sa.Column("closed", sa.Integer, nullable=True))


def downgrade() -> None:
    """Take them away."""
    for name in ("closed", "meetings", "try_again"):
        op.drop_column("plans", name)
