"""Version 0.1.0: requests and answers, robots, commands, trajectories."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0001"
down_revision = None

# On SQLite exactly what version 0.1.0 made; elsewhere the same, in columns of the same capacity.
Id = sa.BigInteger().with_variant(sa.Integer, "sqlite")
Number: Any = sa.Double().with_variant(sa.Float, "sqlite")
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
LongBytes = sa.LargeBinary().with_variant(mysql.LONGBLOB, "mysql", "mariadb")
# Names are case-sensitive.
EXACT: dict[str, Any] = {
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Create the tables of version 0.1.0."""
    _messages("rr")
    _messages("sa")
    _robots()
    _commands()
    _trajectories()


def _messages(name: str) -> None:
    op.create_table(
        name,
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("op", sa.String(32), nullable=False),
        sa.Column("params", LongText, nullable=True),
        sa.Column("payload", LongBytes, nullable=True),
        sa.Column("created_at", sa.DateTime, nullable=False, server_default=sa.func.now()),
        sqlite_autoincrement=True,
        **EXACT,
    )


def _robots() -> None:
    op.create_table(
        "robots",
        sa.Column("name", sa.String(63), primary_key=True),
        sa.Column("magic", Id, nullable=False),
        sa.Column("link", sa.String(16), nullable=False),
        sa.Column("received_at", Number, nullable=False),
        sa.Column("ended_in_order", sa.Integer, nullable=False),
        sa.Column("pose", sa.Text, nullable=True),
        sa.Column("pose_at", Number, nullable=True),
        **EXACT,
    )


def _commands() -> None:
    op.create_table(
        "commands",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("op", sa.String(32), nullable=False),
        sa.Column("params", LongText, nullable=False),
        sa.Column("operator", sa.String(128), nullable=False),
        sa.Column("state", sa.String(16), nullable=False, index=True),
        sa.Column("deviation", Number, nullable=True),
        sa.Column("sa_id", Id, nullable=False),
        sa.Column("created_at", Number, nullable=False, index=True),
        **EXACT,
    )
    op.create_table(
        "command_steps",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("command", sa.String(64), nullable=False, index=True),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("at", Number, nullable=False),
        sa.Column("by", sa.String(128), nullable=False),
        sa.Column("reason", sa.Text, nullable=True),
        sqlite_autoincrement=True,
        **EXACT,
    )


def _trajectories() -> None:
    op.create_table(
        "trajectories",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("received_at", Number, nullable=False, index=True),
        sa.Column("x", Number, nullable=False),
        sa.Column("y", Number, nullable=False),
        sa.Column("theta", Number, nullable=False),
        sa.Column("v", Number, nullable=False),
        sa.Column("device_time", Number, nullable=True),
        **EXACT,
    )
