"""Queues of tasks, placed cones, and a robot's pose at the end of a command."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0004"
down_revision = "0003"

Id = sa.BigInteger().with_variant(sa.Integer, "sqlite")
Number: Any = sa.Double()
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the columns and the tables."""
    for name in ("stood_x", "stood_y", "stood_theta"):
        op.add_column("commands", sa.Column(name, Number, nullable=True))
    _queues()
    _placements()


def _queues() -> None:
    op.create_table(
        "queues",
        sa.Column("robot", sa.String(63), primary_key=True),
        sa.Column("revision", sa.BigInteger, nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("reason", sa.Text, nullable=True),
        sa.Column("by", sa.String(128), nullable=True),
        sa.Column("at", Number, nullable=True),
        **EXACT,
    )
    op.create_table(
        "queue_tasks",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("place", sa.Integer, nullable=False),
        sa.Column("state", sa.String(16), nullable=False, index=True),
        sa.Column("content", LongText, nullable=False),
        sa.Column("leg", sa.Integer, nullable=False),
        sa.Column("attempts", sa.Integer, nullable=False),
        sa.Column("command", sa.String(64), nullable=True),
        sa.Column("added_by", sa.String(128), nullable=False),
        sa.Column("added_at", Number, nullable=False),
        sa.Column("began_at", Number, nullable=True),
        sa.Column("ended_at", Number, nullable=True, index=True),
        sa.Column("reason", sa.Text, nullable=True),
        sa.Column("deviation", Number, nullable=True),
        **EXACT,
    )


def _placements() -> None:
    op.create_table(
        "placements",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("task", sa.String(64), nullable=False, unique=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("command", sa.String(64), nullable=False),
        sa.Column("cone", sa.String(128), nullable=True),
        sa.Column("label", sa.String(128), nullable=True),
        sa.Column("layout", sa.String(128), nullable=True, index=True),
        sa.Column("plan", sa.String(128), nullable=True),
        sa.Column("planned_x", Number, nullable=False),
        sa.Column("planned_y", Number, nullable=False),
        sa.Column("x", Number, nullable=False),
        sa.Column("y", Number, nullable=False),
        sa.Column("theta", Number, nullable=False),
        sa.Column("deviation", Number, nullable=False),
        sa.Column("placed_at", Number, nullable=False, index=True),
        sa.Column("collected_at", Number, nullable=True),
        sa.Column("collected_by", sa.String(63), nullable=True),
        sqlite_autoincrement=True,
        **EXACT,
    )
