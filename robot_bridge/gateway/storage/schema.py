"""The tables.

``rr`` and ``sa`` are the paper's (section IV): robots write requests to the one and read and delete their
answers in the other. The rest belongs to the gateway. ``params`` is JSON text, read by the gateway itself, so
that one robot's bad JSON affects no other row. Ids are never reused: by them a robot distinguishes a repeated
answer from a new one. Times are seconds since 1970-01-01 UTC, but for ``created_at`` of rr and sa.
"""

from __future__ import annotations

from sqlalchemy import (
    BigInteger,
    Column,
    DateTime,
    Double,
    Identity,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    SmallInteger,
    String,
    Table,
    Text,
    UniqueConstraint,
    func,
)
from sqlalchemy.dialects import mysql

metadata = MetaData()

# SQLite numbers rows only if the column's type is INTEGER.
_Id = BigInteger().with_variant(Integer, "sqlite")
# MariaDB's TEXT and BLOB end at 64 KiB, which a path or an image exceeds.
_LongText = Text().with_variant(mysql.MEDIUMTEXT, "mysql", "mariadb")
_LongBytes = LargeBinary().with_variant(mysql.LONGBLOB, "mysql", "mariadb")


def _id() -> Column[int]:
    # On PostgreSQL an identity: robots need no right on its sequence, and can neither read nor advance it.
    return Column("id", _Id, Identity(), primary_key=True, autoincrement=True)


def _robot(*, index: bool = True) -> Column[str]:
    return Column("robot", String(63), nullable=False, index=index)


def _messages(name: str, *more: Column[int]) -> Table:
    return Table(
        name,
        metadata,
        _id(),
        _robot(),
        Column("op", String(32), nullable=False),
        Column("params", _LongText, nullable=True),
        Column("payload", _LongBytes, nullable=True),
        Column("created_at", DateTime, nullable=False, server_default=func.now()),
        *more,
        sqlite_autoincrement=True,
    )


rr = _messages("rr")
# Robots read their rows "order by urgent desc, id": an emergency stop overtakes what waits.
sa = _messages("sa", Column("urgent", SmallInteger, nullable=False, server_default="0"))

# Facts about the database itself: "id" distinguishes it from every other database.
bridge = Table(
    "bridge",
    metadata,
    Column("name", String(32), primary_key=True),
    Column("value", Text, nullable=False),
)

robots = Table(
    "robots",
    metadata,
    Column("name", String(63), primary_key=True),
    Column("magic", BigInteger, nullable=False),
    Column("link", String(16), nullable=False),
    Column("received_at", Double, nullable=False),
    Column("ended_in_order", Integer, nullable=False, default=0),
    Column("pose", Text, nullable=True),
    Column("pose_at", Double, nullable=True),
    Column("paths", String(16), nullable=True),
    Column("abilities", String(128), nullable=True),
)

commands = Table(
    "commands",
    metadata,
    Column("id", String(64), primary_key=True),
    _robot(index=False),
    Column("op", String(32), nullable=False),
    Column("params", _LongText, nullable=False),
    Column("operator", String(128), nullable=False),
    Column("state", String(16), nullable=False, index=True),
    Column("deviation", Double, nullable=True),
    Column("stood_x", Double, nullable=True),
    Column("stood_y", Double, nullable=True),
    Column("stood_theta", Double, nullable=True),
    Column("driven", Double, nullable=True),
    Column("sa_id", BigInteger, nullable=False),
    Column("created_at", Double, nullable=False, index=True),
    Column("expires_at", Double, nullable=True),
    Index("ix_commands_robot_sa_id", "robot", "sa_id"),
    Index("ix_commands_robot_created_at", "robot", "created_at"),
)

command_steps = Table(
    "command_steps",
    metadata,
    _id(),
    Column("command", String(64), nullable=False, index=True),
    Column("state", String(16), nullable=False),
    Column("at", Double, nullable=False),
    Column("by", String(128), nullable=False),
    Column("reason", Text, nullable=True),
    sqlite_autoincrement=True,
)

emergency_stops = Table(
    "emergency_stops",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("at", Double, nullable=False, index=True),
    Column("by", String(128), nullable=False),
    Column("reason", Text, nullable=True),
    Column("cleared_at", Double, nullable=True),
    Column("cleared_by", String(128), nullable=True),
    Column("clear_reason", Text, nullable=True),
)

# ``line`` is the stretch of road, JSON; in force as long as ``opened_at`` is null.
closures = Table(
    "closures",
    metadata,
    Column("id", String(64), primary_key=True),
    Column("line", _LongText, nullable=False),
    Column("level", Integer, nullable=False),
    Column("closed_at", Double, nullable=False),
    Column("closed_by", String(128), nullable=False),
    Column("reason", Text, nullable=True),
    Column("until", Double, nullable=True),
    Column("opened_at", Double, nullable=True, index=True),
    Column("opened_by", String(128), nullable=True),
)

# A robot that waits at the end of ``command`` for another to pass; ``rest`` is the SetPath sent afterwards.
holds = Table(
    "holds",
    metadata,
    Column("robot", String(63), primary_key=True),
    Column("other", String(63), nullable=False),
    Column("command", String(64), nullable=False),
    Column("rest", _LongText, nullable=False),
    Column("until", Double, nullable=False),
    Column("by", String(128), nullable=False),
    Column("task", String(64), nullable=True),
)

queues = Table(
    "queues",
    metadata,
    Column("robot", String(63), primary_key=True),
    Column("revision", BigInteger, nullable=False),
    Column("state", String(16), nullable=False),
    Column("reason", Text, nullable=True),
    Column("by", String(128), nullable=True),
    Column("at", Double, nullable=True),
)

# ``content`` is the operator's input, JSON; ``place`` orders the open tasks of a robot.
queue_tasks = Table(
    "queue_tasks",
    metadata,
    Column("id", String(64), primary_key=True),
    _robot(index=False),
    Column("place", Integer, nullable=False),
    Column("state", String(16), nullable=False, index=True),
    Column("content", _LongText, nullable=False),
    Column("leg", Integer, nullable=False),
    Column("attempts", Integer, nullable=False),
    Column("command", String(64), nullable=True),
    Column("added_by", String(128), nullable=False),
    Column("added_at", Double, nullable=False),
    Column("began_at", Double, nullable=True),
    Column("ended_at", Double, nullable=True, index=True),
    Column("reason", Text, nullable=True),
    Column("deviation", Double, nullable=True),
    Index("ix_queue_tasks_robot_ended_at", "robot", "ended_at"),
)

# Cone plans; ``content`` is the rest of the submission, ``document`` the plan itself, ``proposal`` the plan
# of what is left, ``held`` the robots that wait for it, all JSON. ``meetings`` and ``closed`` count the
# objections to the proposal; ``try_again``: whether it includes failed cones.
plans = Table(
    "plans",
    metadata,
    Column("name", String(128), primary_key=True),
    Column("revision", BigInteger, nullable=False),
    Column("state", String(16), nullable=False, index=True),
    Column("submitted_by", String(128), nullable=False),
    Column("submitted_at", Double, nullable=False),
    Column("by_itself", SmallInteger, nullable=False),
    Column("content", _LongText, nullable=False),
    Column("document", _LongText, nullable=False),
    Column("proposal", _LongText, nullable=True),
    Column("held", _LongText, nullable=False),
    Column("reason", Text, nullable=True),
    Column("by", String(128), nullable=True),
    Column("at", Double, nullable=True),
    Column("ended_at", Double, nullable=True, index=True),
    Column("try_again", SmallInteger, nullable=False, server_default="0"),
    Column("meetings", Integer, nullable=True),
    Column("closed", Integer, nullable=True),
)

# The stops of a plan that are tasks of a queue; ``place`` orders them, ``content`` is the stop, JSON.
plan_stops = Table(
    "plan_stops",
    metadata,
    Column("task", String(64), primary_key=True),
    Column("plan", String(128), nullable=False, index=True),
    _robot(index=False),
    Column("place", Integer, nullable=False),
    Column("number", Integer, nullable=False),
    Column("content", _LongText, nullable=False),
)

# Cones that robots put down; ``task`` is unique, so that none is written twice.
placements = Table(
    "placements",
    metadata,
    _id(),
    Column("task", String(64), nullable=False, unique=True),
    _robot(),
    Column("command", String(64), nullable=False),
    Column("cone", String(128), nullable=True),
    Column("label", String(128), nullable=True),
    Column("layout", String(128), nullable=True, index=True),
    Column("plan", String(128), nullable=True),
    Column("planned_x", Double, nullable=False),
    Column("planned_y", Double, nullable=False),
    Column("x", Double, nullable=False),
    Column("y", Double, nullable=False),
    Column("theta", Double, nullable=False),
    Column("deviation", Double, nullable=False),
    Column("placed_at", Double, nullable=False, index=True),
    Column("collected_at", Double, nullable=True, index=True),
    Column("collected_by", String(63), nullable=True),
    sqlite_autoincrement=True,
)

# On PostgreSQL in partitions of a day, without the primary key, by migration 0011.
trajectories = Table(
    "trajectories",
    metadata,
    _id(),
    _robot(index=False),
    Column("received_at", Double, nullable=False, index=True),
    Column("x", Double, nullable=False),
    Column("y", Double, nullable=False),
    Column("theta", Double, nullable=False),
    Column("v", Double, nullable=False),
    Column("device_time", Double, nullable=True),
    Column("fix_time", Double, nullable=True),
    Index("ix_trajectories_robot_received_at", "robot", "received_at"),
    sqlite_autoincrement=True,
)

# ``source`` is the robot's own number of the observation: reported twice, stored once.
observations = Table(
    "observations",
    metadata,
    _id(),
    _robot(),
    Column("source", String(64), nullable=True),
    Column("kind", String(16), nullable=False),
    Column("object", String(128), nullable=False),
    Column("x", Double, nullable=False),
    Column("y", Double, nullable=False),
    Column("details", Text, nullable=True),
    Column("image", _LongBytes, nullable=True),
    Column("media_type", String(64), nullable=True),
    Column("seen_at", Double, nullable=True),
    Column("received_at", Double, nullable=False, index=True),
    Column("state", String(16), nullable=False, index=True),
    Column("reviewed_at", Double, nullable=True),
    Column("reviewed_by", String(128), nullable=True),
    Column("review", Text, nullable=True),
    UniqueConstraint("robot", "source", name="uq_observations_robot_source"),
    sqlite_autoincrement=True,
)

operators = Table(
    "operators",
    metadata,
    Column("name", String(128), primary_key=True),
    Column("role", String(16), nullable=False),
    Column("created_at", Double, nullable=False),
)

# ``robots`` are the patterns of the names that a link may speak for, with spaces between them.
links = Table(
    "links",
    metadata,
    Column("name", String(16), primary_key=True),
    Column("robots", Text, nullable=False),
    Column("created_at", Double, nullable=False),
)

# ``kind`` is operator, robot or link, ``owner`` the account's name, ``hash`` the SHA-256 of the token.
tokens = Table(
    "tokens",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("kind", String(16), nullable=False),
    Column("owner", String(128), nullable=False, index=True),
    Column("hash", String(64), nullable=False),
    Column("created_at", Double, nullable=False),
    Column("expires_at", Double, nullable=True),
    Column("revoked_at", Double, nullable=True),
    Column("used_at", Double, nullable=True),
)

sessions = Table(
    "sessions",
    metadata,
    Column("id", String(32), primary_key=True),
    Column("operator", String(128), nullable=False, index=True),
    Column("token", String(32), nullable=True),
    Column("role", String(16), nullable=False),
    Column("address", String(64), nullable=False),
    Column("began_at", Double, nullable=False, index=True),
    Column("ended_at", Double, nullable=True, index=True),
    Column("reason", Text, nullable=True),
)

audit = Table(
    "audit",
    metadata,
    _id(),
    Column("at", Double, nullable=False, index=True),
    Column("who", String(128), nullable=False, index=True),
    Column("role", String(16), nullable=True),
    Column("address", String(64), nullable=True),
    Column("action", String(32), nullable=False),
    Column("subject", String(128), nullable=True),
    Column("done", SmallInteger, nullable=False),
    Column("detail", Text, nullable=True),
    sqlite_autoincrement=True,
)

# The gateways of a fleet that several serve. Each lives until ``lease_until``, by the database's own clock,
# unless it renews that; ``run`` distinguishes processes of the same name. ``address`` is where robots reach
# it, ``ws://host:port``, null if unknown.
gateways = Table(
    "gateways",
    metadata,
    Column("gw", String(32), primary_key=True),
    Column("run", String(32), nullable=False),
    Column("version", String(32), nullable=False),
    Column("host", String(255), nullable=False),
    Column("process", BigInteger, nullable=False),
    Column("since", Double, nullable=False),
    Column("lease_until", Double, nullable=False),
    Column("address", String(256), nullable=True),
)

# The run of the gateway that owns each robot: only that run writes the robot's rows. ``fence`` counts its
# owners.
robot_owners = Table(
    "robot_owners",
    metadata,
    Column("robot", String(63), primary_key=True),
    Column("gw", String(32), nullable=False),
    Column("run", String(32), nullable=False),
    Column("fence", BigInteger, nullable=False),
)

# Operators' requests at one gateway about a robot of another one. ``answer`` is JSON, null until there is
# one; ``begun_by`` is the run that began it.
relayed_requests = Table(
    "relayed_requests",
    metadata,
    _id(),
    _robot(),
    Column("method", String(32), nullable=False),
    Column("params", _LongText, nullable=False),
    Column("operator", String(128), nullable=False),
    Column("asked_by", String(32), nullable=False),
    Column("asked_at", Double, nullable=False),
    Column("begun_by", String(32), nullable=True),
    Column("answer", _LongText, nullable=True),
    sqlite_autoincrement=True,
)
