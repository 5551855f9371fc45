"""Closed roads, and robots that wait for others to pass."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0003"
down_revision = "0002"

Number: Any = sa.Double()
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the two tables."""
    op.create_table(
        "closures",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("line", LongText, nullable=False),
        sa.Column("level", sa.Integer, nullable=False),
        sa.Column("closed_at", Number, nullable=False),
        sa.Column("closed_by", sa.String(128), nullable=False),
        sa.Column("reason", sa.Text, nullable=True),
        sa.Column("until", Number, nullable=True),
        sa.Column("opened_at", Number, nullable=True, index=True),
        sa.Column("opened_by", sa.String(128), nullable=True),
        **EXACT,
    )
    op.create_table(
        "holds",
        sa.Column("robot", sa.String(63), primary_key=True),
        sa.Column("other", sa.String(63), nullable=False),
        sa.Column("command", sa.String(64), nullable=False),
        sa.Column("rest", LongText, nullable=False),
        sa.Column("until", Number, nullable=False),
        sa.Column("by", sa.String(128), nullable=False),
        **EXACT,
    )
