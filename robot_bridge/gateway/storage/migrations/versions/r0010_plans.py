"""Cone plans that the gateway drives."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0010"
down_revision = "0009"

Number: Any = sa.Double().with_variant(mysql.DOUBLE(asdecimal=False), "mysql", "mariadb")
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mysql_charset": "utf8mb4",
    "mysql_collate": "utf8mb4_bin",
    "mysql_engine": "InnoDB",
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the tables of plans and of their stops."""
    op.create_table(
        "plans",
        sa.Column("name", sa.String(128), primary_key=True),
        sa.Column("revision", sa.BigInteger, nullable=False),
        sa.Column("state", sa.String(16), nullable=False, index=True),
        sa.Column("submitted_by", sa.String(128), nullable=False),
        sa.Column("submitted_at", Number, nullable=False),
        sa.Column("by_itself", sa.SmallInteger, nullable=False),
        sa.Column("content", LongText, nullable=False),
        sa.Column("document", LongText, nullable=False),
        sa.Column("proposal", LongText, nullable=True),
        sa.Column("held", LongText, nullable=False),
        sa.Column("reason", sa.Text, nullable=True),
        sa.Column("by", sa.String(128), nullable=True),
        sa.Column("at", Number, nullable=True),
        sa.Column("ended_at", Number, nullable=True, index=True),
        **EXACT,
    )
    op.create_table(
        "plan_stops",
        sa.Column("task", sa.String(64), primary_key=True),
        sa.Column("plan", sa.String(128), nullable=False, index=True),
        sa.Column("robot", sa.String(63), nullable=False),
        sa.Column("place", sa.Integer, nullable=False),
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("content", LongText, nullable=False),
        **EXACT,
    )
