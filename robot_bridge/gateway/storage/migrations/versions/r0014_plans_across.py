"""The request and the objections of a plan for the rest: any gateway can continue it."""

import sqlalchemy as sa
from alembic import op

revision = "0014"
down_revision = "0013"


def upgrade() -> None:
    """Add the columns; the objections to a stored proposal are unknown."""
    op.add_column("plans", sa.Column("try_again", sa.SmallInteger, nullable=False, server_default="0"))
    op.add_column("plans", sa.Column("meetings", sa.Integer, nullable=True))
    op.add_column("plans", sa.Column("closed", sa.Integer, nullable=True))


def downgrade() -> None:
    """Drop the columns."""
    for name in ("closed", "meetings", "try_again"):
        op.drop_column("plans", name)
