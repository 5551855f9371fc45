"""Every operation, accounts, emergency stops, observations; an id of the database, notifications."""

from typing import Any

import sqlalchemy as sa
from alembic import op
from sqlalchemy.dialects import mysql

revision = "0002"
down_revision = "0001"

Id = sa.BigInteger().with_variant(sa.Integer, "sqlite")
Number: Any = sa.Double()
LongText = sa.Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
LongBytes = sa.LargeBinary().with_variant(mysql.LONGBLOB, "mysql", "mariadb")
EXACT: dict[str, Any] = {
    "mariadb_charset": "utf8mb4",
    "mariadb_collate": "utf8mb4_bin",
    "mariadb_engine": "InnoDB",
}


def upgrade() -> None:
    """Add the new tables and columns, and keep the rows."""
    _bridge()
    _commands()
    _trajectories()
    _observations()
    _accounts()
    _audit()
    if op.get_bind().dialect.name == "postgresql":
        _notifications()


def _bridge() -> None:
    op.create_table(
        "bridge",
        sa.Column("name", sa.String(32), primary_key=True),
        sa.Column("value", sa.Text, nullable=False),
        **EXACT,
    )


def _commands() -> None:
    op.add_column("sa", sa.Column("urgent", sa.SmallInteger, nullable=False, server_default="0"))
    op.add_column("commands", sa.Column("driven", Number, nullable=True))
    op.add_column("commands", sa.Column("expires_at", Number, nullable=True))
    op.create_table(
        "emergency_stops",
        sa.Column("id", sa.String(64), primary_key=True),
        sa.Column("at", Number, nullable=False, index=True),
        sa.Column("by", sa.String(128), nullable=False),
        sa.Column("reason", sa.Text, nullable=True),
        sa.Column("cleared_at", Number, nullable=True),
        sa.Column("cleared_by", sa.String(128), nullable=True),
        sa.Column("clear_reason", sa.Text, nullable=True),
        **EXACT,
    )


def _trajectories() -> None:
    op.add_column("trajectories", sa.Column("fix_time", Number, nullable=True))
    op.create_index("ix_trajectories_robot_received_at", "trajectories", ["robot", "received_at"])
    op.drop_index("ix_trajectories_robot", "trajectories")


def _observations() -> None:
    op.create_table(
        "observations",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("robot", sa.String(63), nullable=False, index=True),
        sa.Column("source", sa.String(64), nullable=True),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("object", sa.String(128), nullable=False),
        sa.Column("x", Number, nullable=False),
        sa.Column("y", Number, nullable=False),
        sa.Column("details", sa.Text, nullable=True),
        sa.Column("image", LongBytes, nullable=True),
        sa.Column("media_type", sa.String(64), nullable=True),
        sa.Column("seen_at", Number, nullable=True),
        sa.Column("received_at", Number, nullable=False, index=True),
        sa.Column("state", sa.String(16), nullable=False, index=True),
        sa.Column("reviewed_at", Number, nullable=True),
        sa.Column("reviewed_by", sa.String(128), nullable=True),
        sa.Column("review", sa.Text, nullable=True),
        sa.UniqueConstraint("robot", "source", name="uq_observations_robot_source"),
        sqlite_autoincrement=True,
        **EXACT,
    )


def _accounts() -> None:
    op.create_table(
        "operators",
        sa.Column("name", sa.String(128), primary_key=True),
        sa.Column("role", sa.String(16), nullable=False),
        sa.Column("created_at", Number, nullable=False),
        **EXACT,
    )
    op.create_table(
        "tokens",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("owner", sa.String(128), nullable=False, index=True),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.Column("created_at", Number, nullable=False),
        sa.Column("expires_at", Number, nullable=True),
        sa.Column("revoked_at", Number, nullable=True),
        sa.Column("used_at", Number, nullable=True),
        **EXACT,
    )


def _audit() -> None:
    op.create_table(
        "sessions",
        sa.Column("id", sa.String(32), primary_key=True),
        sa.Column("operator", sa.String(128), nullable=False, index=True),
        sa.Column("token", sa.String(32), nullable=True),
        sa.Column("role", sa.String(16), nullable=False),
        sa.Column("address", sa.String(64), nullable=False),
        sa.Column("began_at", Number, nullable=False, index=True),
        sa.Column("ended_at", Number, nullable=True, index=True),
        sa.Column("reason", sa.Text, nullable=True),
        **EXACT,
    )
    op.create_table(
        "audit",
        sa.Column("id", Id, sa.Identity(), primary_key=True, autoincrement=True),
        sa.Column("at", Number, nullable=False, index=True),
        sa.Column("who", sa.String(128), nullable=False, index=True),
        sa.Column("role", sa.String(16), nullable=True),
        sa.Column("address", sa.String(64), nullable=True),
        sa.Column("action", sa.String(32), nullable=False),
        sa.Column("subject", sa.String(128), nullable=True),
        sa.Column("done", sa.SmallInteger, nullable=False),
        sa.Column("detail", sa.Text, nullable=True),
        sqlite_autoincrement=True,
        **EXACT,
    )


def _notifications() -> None:
    """Notify waiting readers. Anyone may listen, so a notification has no content.

    The gateway listens to channel ``rr``, a robot to ``sa_`` and its name (63 characters at most).
    """
    for name, then in (("rr", "'rr'"), ("sa", "left('sa_' || new.robot, 63)")):
        body = f"begin perform pg_notify({then}, ''); return null; end"
        how = "returns trigger language plpgsql set search_path = pg_catalog"
        op.execute(f"create function notify_{name}() {how} as $$ {body} $$")
    # Commands only: reading other answers changes nothing.
    command = "old.op not in ('OpAck', 'SetMap', 'Start')"
    for name, event, each, function in (
        ("rr_inserted", "insert on rr", "statement", "notify_rr"),
        ("sa_deleted", "delete on sa", f"row when ({command})", "notify_rr"),
        ("sa_inserted", "insert on sa", "row", "notify_sa"),
    ):
        op.execute(f"create trigger {name} after {event} for each {each} execute function {function}()")
