"""The tables.

``rr`` and ``sa`` are the paper's (section IV): robots write requests to the one and read and delete their
answers in the other. The rest belongs to the gateway. ``params`` is JSON text, read by the gateway itself,
so that one robot's bad JSON spoils no other row. Ids are never used twice: a robot tells a repeated answer
from a new one by them.
"""

from __future__ import annotations

from sqlalchemy import (
    Column,
    DateTime,
    Float,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    func,
)

metadata = MetaData()


def _messages(name: str) -> Table:
    return Table(
        name,
        metadata,
        Column("id", Integer, primary_key=True, autoincrement=True),
        Column("robot", String(63), nullable=False, index=True),
        Column("op", String(32), nullable=False),
        Column("params", Text, nullable=True),
        Column("payload", LargeBinary, nullable=True),
        Column("created_at", DateTime, nullable=False, server_default=func.now()),
        sqlite_autoincrement=True,
    )


rr = _messages("rr")
sa = _messages("sa")

robots = Table(
    "robots",
    metadata,
    Column("name", String(63), primary_key=True),
    Column("magic", Integer, nullable=False),
    Column("link", String(16), nullable=False),
    Column("received_at", Float, nullable=False),
    Column("ended_in_order", Integer, nullable=False, default=0),
    Column("pose", Text, nullable=True),
    Column("pose_at", Float, nullable=True),
)

commands = Table(
    "commands",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("robot", String(63), nullable=False, index=True),
    Column("op", String(32), nullable=False),
    Column("params", Text, nullable=False),
    Column("operator", String(128), nullable=False),
    Column("state", String(16), nullable=False, index=True),
    Column("deviation", Float, nullable=True),
    Column("sa_id", Integer, nullable=False),
    Column("created_at", Float, nullable=False, index=True),
)

command_steps = Table(
    "command_steps",
    metadata,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("command", String(64), nullable=False, index=True),
    Column("state", String(16), nullable=False),
    Column("at", Float, nullable=False),
    Column("by", String(128), nullable=False),
    Column("reason", Text, nullable=True),
    sqlite_autoincrement=True,
)

trajectories = Table(
    "trajectories",
    metadata,
    Column("id", Integer, primary_key=True, autoincrement=True),
    Column("robot", String(63), nullable=False, index=True),
    Column("received_at", Float, nullable=False, index=True),
    Column("x", Float, nullable=False),
    Column("y", Float, nullable=False),
    Column("theta", Float, nullable=False),
    Column("v", Float, nullable=False),
    Column("device_time", Float, nullable=True),
)
