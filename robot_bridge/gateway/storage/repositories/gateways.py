"""Gateways of a fleet that several serve: their leases, the owners of robots, and relayed requests.

PostgreSQL only. Times are seconds by the database's own clock, shared by all gateways; ``now`` replaces it in
tests.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import msgspec
from sqlalchemy import Connection, text

from ....core.clock import Clock
from ....core.errors import StoreError
from ....core.messages.base import DeskRequest, to_json

_NOW = "coalesce(cast(:now as double precision), extract(epoch from clock_timestamp())::double precision)"
_ALIVE = f"g.lease_until > {_NOW}"


class Member(NamedTuple):
    """A gateway of the fleet; ``since`` is when it joined, ``left`` the remaining seconds of its lease.

    A later member has a later ``since``, even if the database's clock was set back. ``address`` is where
    robots reach it: empty if unknown, None if not known yet, so that the previous one holds.
    """

    gw: str
    run: str
    version: str = ""
    host: str = ""
    process: int = 0
    since: float = 0.0
    left: float = 0.0
    address: str | None = None

    @property
    def alive(self) -> bool:
        """Whether its lease has not run out."""
        return self.left > 0


class Owner(NamedTuple):
    """The run of the gateway that owns a robot; ``fence`` counts its owners so far.

    ``stored`` is false for a robot without a stored row: it is new, or was removed.
    """

    gw: str
    run: str
    fence: int
    stored: bool = True


class OwnersRead(NamedTuple):
    """Owners of robots, those that changed ``since`` the mark of an earlier read, or all without one.

    Those of robots that are not stored are always included; ``total`` is the number of all owners.
    """

    mark: str
    total: int
    owners: dict[str, Owner]


class Claimed(NamedTuple):
    """A claimed robot: the fence of its new owner, and the previous owner, if any."""

    fence: int
    before: Owner | None


class NoMemberError(StoreError):
    """A gateway with an expired lease, or whose name another process took, claims robots."""


# --- Leases ---

_JOIN = text(
    f"""
    insert into gateways (gw, run, version, host, process, since, lease_until, address)
    select :gw, :run, :version, :host, :process, greatest({_NOW}, max(since) + 0.001), {_NOW} + :lease,
        :address
    from gateways
    on conflict (gw) do update set run = excluded.run, version = excluded.version, host = excluded.host,
        process = excluded.process, since = excluded.since, lease_until = excluded.lease_until,
        address = coalesce(excluded.address, gateways.address)
    where gateways.run = excluded.run or gateways.lease_until <= {_NOW}
    returning run
    """  # nosec B608 # names of ours
)
_ONE_JOINS = text("lock table gateways in share row exclusive mode")
_RENEW = text(
    f"""
    update gateways set lease_until = {_NOW} + :lease, address = coalesce(:address, address)
    where gw = :gw and run = :run and lease_until > {_NOW} returning since
    """  # nosec B608 # names of ours
)
_MEMBERS = text(
    f"select gw, run, version, host, process, since, lease_until - {_NOW}, address, {_NOW} "  # nosec B608 # names of ours
    "from gateways order by since, gw"
)
_LEAVE = text("delete from gateways where gw = :gw and run = :run")
_STRIKE_GONE = text(f"delete from gateways g where g.lease_until < {_NOW} - :age returning gw")  # nosec B608 # names of ours


def join(connection: Connection, me: Member, lease_s: float, now: float | None = None) -> bool:
    """Enter a gateway for ``lease_s`` seconds; return false if another one of its name lives."""
    # Serialised: a gateway that sees no older one must be the oldest.
    connection.execute(_ONE_JOINS)
    values = {**me._asdict(), "lease": lease_s, "now": now}
    return connection.execute(_JOIN, values).first() is not None


def renew(connection: Connection, me: Member, lease_s: float, now: float | None = None) -> bool:
    """Renew a gateway's lease for ``lease_s`` seconds, with its address; return false if it has expired."""
    values = {"gw": me.gw, "run": me.run, "address": me.address, "lease": lease_s, "now": now}
    return connection.execute(_RENEW, values).first() is not None


def members(connection: Connection, now: float | None = None) -> list[Member]:
    """Return all entered gateways, the first joined one first."""
    return [Member(*row[:-1]) for row in connection.execute(_MEMBERS, {"now": now})]


class MembersRead(NamedTuple):
    """All gateways, the database's time and this computer's clock, both of the same moment.

    Without gateways the times are equal and have no meaning.
    """

    members: list[Member]
    database: float
    here: float


def renew_and_read(connection: Connection, me: Member, lease_s: float, clock: Clock) -> MembersRead | None:
    """Renew a lease as :func:`renew` does; return all gateways, None if the lease has expired."""
    return read_members(connection, clock) if renew(connection, me, lease_s) else None


def read_members(connection: Connection, clock: Clock) -> MembersRead:
    """Return all entered gateways, with the times of both clocks."""
    began = clock.time()
    rows = connection.execute(_MEMBERS, {"now": None}).all()
    here = (began + clock.time()) / 2
    return MembersRead([Member(*row[:-1]) for row in rows], float(rows[-1][-1]) if rows else here, here)


def leave(connection: Connection, me: Member) -> None:
    """Remove a gateway: its robots have no owner at once."""
    connection.execute(_LEAVE, {"gw": me.gw, "run": me.run})


def strike_gone(connection: Connection, age_s: float, now: float | None = None) -> list[str]:
    """Remove the gateways whose lease expired more than ``age_s`` seconds ago; return their names."""
    return sorted(connection.scalars(_STRIKE_GONE, {"age": age_s, "now": now}))


# --- Owners of robots ---

_IS_ALIVE = text(f"select 1 from gateways g where g.gw = :gw and g.run = :run and {_ALIVE}")  # nosec B608 # names of ours
_LOCKED = text(
    "select robot, gw, run, fence from robot_owners where robot = any(:robots) order by robot for update"
)
_CLAIM = text(
    """
    insert into robot_owners (robot, gw, run, fence)
    select robot, :gw, :run, 1 from unnest(cast(:robots as text[])) as robot order by robot
    on conflict (robot) do update set gw = excluded.gw, run = excluded.run, fence = robot_owners.fence + 1
    where (robot_owners.gw, robot_owners.run) is distinct from (excluded.gw, excluded.run)
    returning robot, fence
    """
)
_CLAIM_LEFT = text(
    f"""
    update robot_owners o set gw = :gw, run = :run, fence = o.fence + 1
    where o.run <> all(cast(:spared as text[]))
        and not exists (select 1 from gateways g where g.gw = o.gw and g.run = o.run and {_ALIVE})
    returning robot, fence
    """  # nosec B608 # names of ours
)
_CLAIM_NEW = text(
    """
    insert into robot_owners (robot, gw, run, fence)
    select name, :gw, :run, 1 from robots r
    where not exists (select 1 from robot_owners o where o.robot = r.name)
    on conflict (robot) do nothing returning robot, fence
    """
)
_HELD = text(
    "select robot, fence from robot_owners where robot = any(:robots) and gw = :gw and run = :run "
    "order by robot for share"
)
FEW = 100
"""robots whose fences are compared here: a comparison in the database takes 0.7 ms more for so few."""
_LOST = text(
    """
    with fences as (
        select key as robot, cast(value as bigint) as fence from json_each_text(cast(:fences as json))
    ),
    held as (
        select o.robot from fences f join robot_owners o on o.robot = f.robot and o.fence = f.fence
        where o.gw = :gw and o.run = :run order by o.robot for share of o
    )
    select robot from fences except select robot from held
    """
)
# A row with the total and the mark, beside those of owners, which have null there.
_ABOUT = "select null, null, null, count(*), null, cast(pg_snapshot_xmin(pg_current_snapshot()) as text)"
_OWNERS = "select o.robot, o.gw, o.run, o.fence, r.name is not null, null from robot_owners o"
_KNOWN = "left join robots r on r.name = o.robot"
# Transactions unfinished when the mark was read, and all later ones, are at most as old as the mark.
_SINCE = "where r.name is null or age(o.xmin) <= age(xid(cast(:since as xid8)))"
_ALL = text(f"{_ABOUT} from robot_owners union all {_OWNERS} {_KNOWN}")  # nosec B608 # names of ours
_CHANGED = text(f"{_ABOUT} from robot_owners union all {_OWNERS} {_KNOWN} {_SINCE}")  # nosec B608 # names of ours
_PRESENT = text(
    "select count(*) from robots r join robot_owners o on o.robot = r.name where o.gw = :gw and o.run = :run"
)


def claim(
    connection: Connection, me: Member, robots: Sequence[str], now: float | None = None
) -> dict[str, Claimed]:
    """Make a gateway the owner of some robots, from any owner: their newest connection counts.

    Robots that it owns already stay unchanged, including the fence.

    :raises NoMemberError: when its lease has expired.
    """
    _check_alive(connection, me, now)
    names = sorted(set(robots))
    before = {row[0]: Owner(*row[1:]) for row in connection.execute(_LOCKED, {"robots": names})}
    got: dict[str, int] = dict(
        connection.execute(_CLAIM, {"gw": me.gw, "run": me.run, "robots": names}).all()
    )
    mine = {robot: owner.fence for robot, owner in before.items() if robot not in got}
    return {robot: Claimed(fence, before.get(robot)) for robot, fence in {**mine, **got}.items()}


def claim_left(
    connection: Connection, me: Member, spared: Sequence[str] = (), now: float | None = None
) -> dict[str, int]:
    """Make a gateway the owner of all robots without a living owner; return their fences.

    Robots of the runs ``spared`` stay where they are.

    :raises NoMemberError: when its own lease has expired.
    """
    _check_alive(connection, me, now)
    values = {"gw": me.gw, "run": me.run}
    left = connection.execute(_CLAIM_LEFT, {**values, "spared": list(spared), "now": now}).all()
    new = connection.execute(_CLAIM_NEW, values).all()
    return dict([*left, *new])


def lost(connection: Connection, me: Member, fences: Mapping[str, int]) -> set[str]:
    """Return the robots not owned by a gateway under ``fences``; the others stay its own until the commit."""
    values: dict[str, Any] = {"gw": me.gw, "run": me.run}
    if len(fences) <= FEW:
        held: dict[str, int] = dict(connection.execute(_HELD, {**values, "robots": list(fences)}).all())
        return {robot for robot, fence in fences.items() if held.get(robot) != fence}
    values["fences"] = msgspec.json.encode(fences).decode()
    return set(connection.scalars(_LOST, values))


def owners_since(connection: Connection, since: str | None) -> OwnersRead:
    """Return the owners changed since the mark of an earlier read, whenever that was committed."""
    # One statement sees one state: transactions that end meanwhile are read again next time.
    rows = connection.execute(_ALL) if since is None else connection.execute(_CHANGED, {"since": since})
    mark, total, found = "", 0, {}
    for robot, *owner, about in rows:
        if about is None:
            found[robot] = Owner(*owner)
        else:
            mark, total = about, owner[2]
    return OwnersRead(mark, total, found)


def present(connection: Connection, me: Member) -> int:
    """Return how many of a gateway's robots are stored."""
    return int(connection.execute(_PRESENT, {"gw": me.gw, "run": me.run}).scalar_one())


def _check_alive(connection: Connection, me: Member, now: float | None) -> None:
    values = {"gw": me.gw, "run": me.run, "now": now}
    if connection.execute(_IS_ALIVE, values).first() is None:
        raise NoMemberError(
            f"gateway {me.gw!r} is no member of the fleet at the moment: its lease in the database has run "
            "out; it claims no robot until it could renew that"
        )


# --- Requests about robots of other gateways: asked, begun by the owner, answered ---

_CLOCK = "extract(epoch from clock_timestamp())::double precision"
_ADD = text(
    f"""
    insert into relayed_requests (robot, method, params, operator, asked_by, asked_at)
    values (:robot, :method, :params, :operator, :asked_by,
        least(cast(:asked_at as double precision), {_CLOCK})) returning id
    """  # nosec B608 # names of ours
)
_OPEN = """
    from relayed_requests q join robot_owners o on o.robot = q.robot
    where o.gw = :gw and o.run = :run and q.answer is null and q.begun_by is distinct from :run
"""
_IS_ASKED = text(f"select exists(select 1 {_OPEN})")  # nosec B608 # names of ours
_BEGIN = text(
    f"""
    with mine as (
        select q.id, q.begun_by {_OPEN} order by q.id limit :most for update of q skip locked
    )
    update relayed_requests q set begun_by = :run from mine where q.id = mine.id
    returning q.id, q.robot, q.method, q.params, q.operator, q.asked_by, {_CLOCK} - q.asked_at, mine.begun_by
    """  # nosec B608 # names of ours
)
_ANSWER = text("update relayed_requests set answer = :answer where id = :id and answer is null")
_COLLECT = text(
    "delete from relayed_requests where id = any(:ids) and answer is not null returning id, answer"
)
_WITHDRAW = text(
    "delete from relayed_requests where id = any(:ids) and begun_by is null and answer is null returning id"
)
_FORGET = text(f"delete from relayed_requests where asked_at < {_CLOCK} - :age")  # nosec B608 # names of ours


class NewRequest(NamedTuple):
    """A request about a robot, by the name of its method, with its parameters as JSON."""

    robot: str
    method: str
    params: str

    @classmethod
    def of(cls, robot: str, request: DeskRequest[Any]) -> NewRequest:
        """Return a request as it is stored."""
        return cls(robot, request.method, msgspec.json.encode(to_json(request)).decode())


class TakenRequest(NamedTuple):
    """A request that a gateway began to process ``age`` seconds after it was made.

    ``begun_by`` is an earlier run that began it and did not answer.
    """

    id: int
    robot: str
    method: str
    params: str
    operator: str
    asked_by: str
    age: float
    begun_by: str | None


def add_requests(
    connection: Connection,
    requests: Sequence[NewRequest],
    operator: str,
    asked_by: str,
    asked_at: float | None = None,
) -> list[int]:
    """Write requests, asked at ``asked_at`` (database time, s), else now; return their ids in order."""
    more = {"operator": operator, "asked_by": asked_by, "asked_at": asked_at}
    return [int(connection.execute(_ADD, {**one._asdict(), **more}).scalar_one()) for one in requests]


def is_asked(connection: Connection, me: Member) -> bool:
    """Return whether there are requests that :func:`begin_requests` would return."""
    return bool(connection.execute(_IS_ASKED, {"gw": me.gw, "run": me.run}).scalar_one())


def begin_requests(connection: Connection, me: Member, most: int) -> list[TakenRequest]:
    """Return the oldest requests of robots that a gateway has, each once to each of its runs."""
    rows = connection.execute(_BEGIN, {"gw": me.gw, "run": me.run, "most": most})
    return sorted(TakenRequest(*row) for row in rows)


def answer_request(connection: Connection, id: int, answer: str) -> None:
    """Write the answer to a request, which is JSON."""
    connection.execute(_ANSWER, {"id": id, "answer": answer})


def collect_answers(connection: Connection, ids: Sequence[int]) -> dict[int, str]:
    """Return the present answers to some requests, and remove these requests."""
    return dict(connection.execute(_COLLECT, {"ids": list(ids)}).all())


def withdraw_requests(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Withdraw those of some requests that nobody has begun; return them."""
    return set(connection.scalars(_WITHDRAW, {"ids": list(ids)}))


def forget_requests(connection: Connection, age_s: float) -> int:
    """Delete requests that were asked more than ``age_s`` seconds ago; return how many."""
    return connection.execute(_FORGET, {"age": age_s}).rowcount
