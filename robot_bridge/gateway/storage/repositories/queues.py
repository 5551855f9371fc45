"""Queues of tasks: a change is written only if the queue is unchanged since the writer read it."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import msgspec
from sqlalchemy import (
    Connection,
    Select,
    Update,
    bindparam,
    delete,
    exists,
    insert,
    or_,
    select,
    text,
    update,
)
from sqlalchemy.dialects import postgresql

from ....core.errors import RefusedError
from ....core.json_decoder import decode_json
from ....core.messages.base import to_json
from ....core.messages.queues import QueueState, QueueTask, TaskState
from ...model.task_queue import ENDS, Queue, QueuedTask, Whereabouts
from ..rows import beside_the_time, delete_oldest, is_one_of, readable
from ..schema import plan_stops, plans, queue_tasks, queues

_ENDED = [state.value for state in ENDS]
_OPEN = [state.value for state in TaskState if state not in ENDS]

# Built once: SQLAlchemy takes longer to build a statement than the database to do it.
_OF_ROBOT = queues.c.robot == bindparam("of")
_IS_STORED = select(queues.c.robot).where(_OF_ROBOT)
# Locked: changes of a queue by several gateways are serialised.
_REVISION = select(queues.c.revision, queues.c.state).where(_OF_ROBOT).with_for_update()
_QUEUE_COLUMNS = ("revision", "state", "reason", "by", "at")
_SAVE_QUEUE = (
    update(queues).where(_OF_ROBOT).values({name: bindparam(f"new_{name}") for name in _QUEUE_COLUMNS})
)


# Every change of a row gives it another xmin.
_VERSION = (
    "concat_ws(' ', max(cast(q.xmin as text)), count(t.id), "
    "sum(cast(cast(t.xmin as text) as numeric) * (t.place + 1)))"
)
_OPEN_TASKS = "left join queue_tasks t on t.robot = q.robot and t.state = any(:open)"
_VERSIONS_ELSEWHERE = text(
    f"select q.robot, {_VERSION} from queues q "  # nosec B608 # names of ours
    f"join robot_owners o on o.robot = q.robot and o.gw <> :gw {_OPEN_TASKS} group by q.robot"
)
_VERSIONS = text(
    f"select q.robot, {_VERSION} from queues q {_OPEN_TASKS} "  # nosec B608 # names of ours
    "where q.robot = any(:robots) group by q.robot"
)
_REVISIONS_OF = text(
    "select q.robot, q.revision from queues q join robot_owners o on o.robot = q.robot and o.gw = :gw"
)
# Each robot's own rows by the index, newest first: a robot in use for years has thousands of ended ones.
_NEWEST_ENDED_OF_ONE = (
    select(queue_tasks)
    .where(queue_tasks.c.robot == bindparam("of"), beside_the_time(queue_tasks.c.state).in_(_ENDED))
    .order_by(queue_tasks.c.ended_at.desc(), queue_tasks.c.place.desc())
    .limit(bindparam("most"))
)
_NEWEST_ENDED = text(
    "select t.* from unnest(cast(:robots as text[])) of (robot) cross join lateral "
    "(select * from queue_tasks where robot = of.robot and state || '' = any(:ended) "
    "order by ended_at desc, place desc limit :most) t order by t.robot, t.ended_at desc, t.place desc"
)
IDLE_S = 2
"""seconds that a transaction may be idle that changes queues of other gateways' robots."""


class ChangedError(RefusedError):
    """The queue was changed by somebody else since it was read."""


class QueueHold(NamedTuple):
    """A pause of a robot's queue: why, by whom and when."""

    robot: str
    reason: str
    by: str
    at: float


def load(connection: Connection, robots: Sequence[str] | None = None) -> dict[str, Queue]:
    """Return the queues of some robots, or of all, with their open tasks."""
    query = select(queues)
    open_tasks = select(queue_tasks).where(queue_tasks.c.state.in_(_OPEN))
    if robots is not None:
        query = query.where(is_one_of(connection, queues.c.robot, robots))
        open_tasks = open_tasks.where(is_one_of(connection, queue_tasks.c.robot, robots))
    tasks: dict[str, list[QueuedTask]] = {}
    rows = connection.execute(open_tasks.order_by(queue_tasks.c.place)).mappings()
    for robot, task in readable(rows, lambda row: (row["robot"], _task(row)), _name_of_task):
        tasks.setdefault(robot, []).append(task)
    found = connection.execute(query).mappings()
    read = readable(found, lambda row: _queue(row, tasks), lambda row: f"the queue of robot {row['robot']}")
    return {queue.robot: queue for queue in read}


def load_with_ended(
    connection: Connection, robots: Sequence[str], limit: int
) -> list[tuple[Queue, list[QueuedTask]]]:
    """Return the queues of some robots, each with its newest tasks that ended, ``limit`` at most."""
    found = load(connection, robots)
    ended = newest_ended_of(connection, list(found), limit)
    return [(queue, ended[robot]) for robot, queue in found.items()]


def versions_elsewhere(connection: Connection, gateway: str) -> dict[str, str]:
    """Return a version of each queue of other gateways' robots; PostgreSQL only."""
    values = {"gw": gateway, "open": _OPEN}
    return dict(connection.execute(_VERSIONS_ELSEWHERE, values).all())


def versions(connection: Connection, robots: Sequence[str]) -> dict[str, str]:
    """Return versions of the queues of some robots; PostgreSQL only."""
    return dict(connection.execute(_VERSIONS, {"robots": list(robots), "open": _OPEN}).all())


def revisions_of(connection: Connection, gateway: str) -> dict[str, int]:
    """Return the revisions of the queues of a gateway's robots; PostgreSQL only."""
    return dict(connection.execute(_REVISIONS_OF, {"gw": gateway}).all())


def check_unchanged(connection: Connection, taken_for: Sequence[Queue]) -> None:
    """Raise ChangedError unless the stored queues equal ``taken_for``, task by task.

    They stay so until the transaction ends. It does not wait for locks, and an idle caller blocks others for
    :data:`IDLE_S` at most. PostgreSQL only.
    """
    if not taken_for:
        return
    connection.execute(text(f"set local idle_in_transaction_session_timeout = '{IDLE_S}s'"))
    known = {queue.robot: queue for queue in taken_for}
    rows = select(queues.c.robot).where(queues.c.robot.in_(known)).order_by(queues.c.robot)
    locked = set(connection.scalars(rows.with_for_update(skip_locked=True)))
    stored = load(connection, sorted(known))
    for robot, queue in known.items():
        if (robot in stored) != (robot in locked) or stored.get(robot, Queue(robot)) != queue:
            raise _changed(robot)


def _changed(robot: str) -> ChangedError:
    return ChangedError(f"the queue of robot {robot!r} was changed meanwhile; look at it again")


def _queue(row: Any, tasks: Mapping[str, Sequence[QueuedTask]]) -> Queue:
    return Queue(
        robot=row["robot"],
        revision=row["revision"],
        state=QueueState(row["state"]),
        tasks=tuple(tasks.get(row["robot"], ())),
        reason=row["reason"],
        by=row["by"],
        at=row["at"],
    )


def newest_ended(connection: Connection, robot: str, limit: int) -> list[QueuedTask]:
    """Return the tasks of a robot that ended, newest first."""
    return _tasks(connection, _NEWEST_ENDED_OF_ONE, {"of": robot, "most": limit})


def newest_ended_of(connection: Connection, robots: Sequence[str], limit: int) -> dict[str, list[QueuedTask]]:
    """Return the tasks of each of some robots that ended, newest first, ``limit`` at most."""
    if connection.dialect.name != "postgresql":
        # SQLite and MariaDB take as long for one statement on many robots as for many on one.
        return {robot: newest_ended(connection, robot, limit) for robot in robots}
    found: dict[str, list[QueuedTask]] = {robot: [] for robot in robots}
    rows = connection.execute(_NEWEST_ENDED, {"robots": list(robots), "ended": _ENDED, "most": limit})
    for robot, task in readable(rows.mappings(), lambda row: (row["robot"], _task(row)), _name_of_task):
        found[robot].append(task)
    return found


def find_all(connection: Connection, tasks: Sequence[str]) -> dict[str, tuple[str, QueuedTask]]:
    """Return some tasks, each with the robot whose queue it is or was in; those not stored are missing."""
    found: dict[str, tuple[str, QueuedTask]] = {}
    for begin in range(0, len(tasks), 500):
        query = select(queue_tasks).where(queue_tasks.c.id.in_(tasks[begin : begin + 500]))
        rows = connection.execute(query).mappings()
        found.update(readable(rows, lambda row: (row["id"], (row["robot"], _task(row))), _name_of_task))
    return found


def whereabouts(connection: Connection, tasks: Sequence[str]) -> dict[str, Whereabouts]:
    """Return where those of some tasks are that were given earlier."""
    c = queue_tasks.c
    found: dict[str, Whereabouts] = {}
    for begin in range(0, len(tasks), 500):
        query = select(c.id, c.robot, c.state).where(c.id.in_(tasks[begin : begin + 500]))
        found.update(
            {row.id: Whereabouts(row.robot, TaskState(row.state)) for row in connection.execute(query)}
        )
    return found


def save(connection: Connection, before: Queue, after: Queue, ended: Iterable[QueuedTask] = ()) -> None:
    """Write the differences of ``after`` and the ``ended`` tasks from ``before``.

    :raises ChangedError: when the stored queue is no longer ``before``; nothing may be written then.
    """
    _save_queue(connection, before, after)
    old = {task.id: task for task in before.tasks}
    _save_tasks(connection, after.robot, old, [*after.tasks, *ended])


def save_each(connection: Connection, changes: Sequence[tuple[Queue, Queue, Sequence[QueuedTask]]]) -> None:
    """Write several queues, each as :func:`save` does; raises ChangedError, and nothing may be written."""
    for before, after, ended in changes:
        save(connection, before, after, ended)


def save_many(connection: Connection, changes: Sequence[tuple[Queue, Queue]]) -> None:
    """Write several queues between which tasks have moved; raises ChangedError as :func:`save`."""
    old = {task.id: task for before, _ in changes for task in before.tasks}
    owner = {task.id: before.robot for before, _ in changes for task in before.tasks}
    for before, after in changes:
        _save_queue(connection, before, after)
        came = {task.id for task in after.tasks if owner.get(task.id) != after.robot}
        statement = update(queue_tasks).where(queue_tasks.c.id == bindparam("key"))
        if came:
            rows = [{"key": id, "to": after.robot} for id in sorted(came)]
            connection.execute(statement.values(robot=bindparam("to")), rows)
        _save_tasks(connection, after.robot, old, after.tasks)


def hold(connection: Connection, holds: Sequence[QueueHold]) -> None:
    """Pause the queues of robots commanded beside them; idle ones stay as they are."""
    if not holds:
        return
    # No IN: it cannot be used in a statement executed for many rows.
    is_open = or_(*(queue_tasks.c.state == state for state in _OPEN))
    waiting = exists().where(queue_tasks.c.robot == queues.c.robot, is_open)
    statement = (
        update(queues)
        .where(queues.c.robot == bindparam("of"), queues.c.state == QueueState.RUNNING.value, waiting)
        .values(
            state=QueueState.PAUSED.value,
            revision=queues.c.revision + 1,
            reason=bindparam("why"),
            by=bindparam("who"),
            at=bindparam("since"),
        )
    )
    rows = [{"of": hold.robot, "why": hold.reason, "who": hold.by, "since": hold.at} for hold in holds]
    connection.execute(statement, rows)


def forget(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` tasks that ended before a time; return how many."""
    c = queue_tasks.c
    has_ended = beside_the_time(c.state).in_(_ENDED)
    return len(delete_oldest(connection, c.id, c.ended_at, before, limit, has_ended))


def forget_plans(connection: Connection, before: float, limit: int) -> int:
    """Delete at most ``limit`` plans that ended before a time, with their stops; return how many."""
    gone = delete_oldest(connection, plans.c.name, plans.c.ended_at, before, limit)
    for name in gone:
        connection.execute(delete(plan_stops).where(plan_stops.c.plan == name))
    return len(gone)


def _save_queue(connection: Connection, before: Queue, after: Queue) -> None:
    values = after.revision, after.state.value, after.reason, after.by, after.at
    row, of = dict(zip(_QUEUE_COLUMNS, values, strict=True)), {"of": after.robot}
    if before.revision == 0 and connection.execute(_IS_STORED, of).first() is None:
        adding = insert(queues)
        if connection.dialect.name == "postgresql":
            # Two gateways may insert it at once.
            adding = postgresql.insert(queues).on_conflict_do_nothing()
        if connection.execute(adding, {"robot": after.robot, **row}).rowcount == 0:
            raise _changed(after.robot)
        return
    # Queried, since MariaDB does not count a row updated without a change.
    found = connection.execute(_REVISION, of).first()
    if found is None or (found.revision, found.state) != (before.revision, before.state.value):
        raise _changed(after.robot)
    if (before.revision, before.state) != (after.revision, after.state):
        connection.execute(_SAVE_QUEUE, {**of, **{f"new_{name}": value for name, value in row.items()}})


def _save_tasks(
    connection: Connection, robot: str, old: dict[str, QueuedTask], tasks: Iterable[QueuedTask]
) -> None:
    changed = [task for task in tasks if old.get(task.id) != task]
    new = [task for task in changed if task.id not in old]
    if new:
        rows = [{"robot": robot, "id": task.id, **_content(task), **_row(task)} for task in new]
        connection.execute(insert(queue_tasks), rows)
    known = [task for task in changed if task.id in old]
    # The operator's input contains a path, and is written only if changed.
    _update(connection, [(task.id, _row(task)) for task in known if task.task == old[task.id].task])
    other = [task for task in known if task.task != old[task.id].task]
    _update(connection, [(task.id, {**_row(task), **_content(task)}) for task in other])


def _update(connection: Connection, changes: Sequence[tuple[str, dict[str, Any]]]) -> None:
    if not changes:
        return
    rows = [{"key": id, **{f"new_{name}": v for name, v in row.items()}} for id, row in changes]
    connection.execute(_update_of(tuple(changes[0][1])), rows)


@functools.cache
def _update_of(names: tuple[str, ...]) -> Update:
    values: dict[str, Any] = {name: bindparam(f"new_{name}") for name in names}
    return update(queue_tasks).where(queue_tasks.c.id == bindparam("key")).values(values)


def _content(task: QueuedTask) -> dict[str, Any]:
    return {"content": json.dumps(to_json(task.task))}


def _row(task: QueuedTask) -> dict[str, Any]:
    return {
        "place": task.place,
        "state": task.state.value,
        "leg": task.leg,
        "attempts": task.attempts,
        "command": task.command,
        "added_by": task.added_by,
        "added_at": task.added_at,
        "began_at": task.began_at,
        "ended_at": task.ended_at,
        "reason": task.reason,
        "deviation": task.deviation,
    }


def _tasks(
    connection: Connection, query: Select[Any], values: Mapping[str, Any] | None = None
) -> list[QueuedTask]:
    return list(readable(connection.execute(query, values).mappings(), _task, _name_of_task))


def _name_of_task(row: Any) -> str:
    return f"task {row['id']} of the queue of robot {row['robot']}"


def _task(row: Any) -> QueuedTask:
    return QueuedTask(
        task=msgspec.convert(decode_json(row["content"]), QueueTask),
        added_by=row["added_by"],
        added_at=row["added_at"],
        state=TaskState(row["state"]),
        place=row["place"],
        leg=row["leg"],
        attempts=row["attempts"],
        command=row["command"],
        began_at=row["began_at"],
        ended_at=row["ended_at"],
        reason=row["reason"],
        deviation=row["deviation"],
    )
