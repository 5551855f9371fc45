"""What operators ask at one gateway of robots that another one has: asked, taken by the owner, answered.

PostgreSQL alone; times are seconds by the database's clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import msgspec
from sqlalchemy import Connection, text

from ....core.messages.base import DeskRequest
from ....core.messages.json_values import to_json
from .gateways import Member

_NOW = "extract(epoch from clock_timestamp())::double precision"
_ADD = text(
    f"""
    insert into relayed_requests (robot, method, params, operator, asked_by, asked_at)
    values (:robot, :method, :params, :operator, :asked_by, {_NOW}) returning id
    """  # nosec B608 # names of ours
)
_BEGIN = text(
    f"""
    with mine as (
        select q.id, q.begun_by from relayed_requests q join robot_owners o on o.robot = q.robot
        where o.gw = :gw and o.run = :run and q.answer is null and q.begun_by is distinct from :run
        order by q.id limit :most for update of q skip locked
    )
    update relayed_requests q set begun_by = :run from mine where q.id = mine.id
    returning q.id, q.robot, q.method, q.params, q.operator, q.asked_by, {_NOW} - q.asked_at, mine.begun_by
    """  # nosec B608 # names of ours
)
_ANSWER = text("update relayed_requests set answer = :answer where id = :id and answer is null")
_COLLECT = text(
    "delete from relayed_requests where id = any(:ids) and answer is not null returning id, answer"
)
_WITHDRAW = text(
    "delete from relayed_requests where id = any(:ids) and begun_by is null and answer is null returning id"
)
_FORGET = text(f"delete from relayed_requests where asked_at < {_NOW} - :age")  # nosec B608 # names of ours


class NewRequest(NamedTuple):
    """A request of a robot, by the name of its method, with its parameters as JSON."""

    robot: str
    method: str
    params: str

    @classmethod
    def of(cls, robot: str, request: DeskRequest[Any]) -> NewRequest:
        """Return a request as it is stored."""
        return cls(robot, request.method, msgspec.json.encode(to_json(request)).decode())


class TakenRequest(NamedTuple):
    """A request that a gateway began to deal with ``age`` seconds after it was asked.

    ``begun_by`` is an earlier run that began to do so and did not answer.
    """

    id: int
    robot: str
    method: str
    params: str
    operator: str
    asked_by: str
    age: float
    begun_by: str | None


def add(connection: Connection, requests: Sequence[NewRequest], operator: str, asked_by: str) -> list[int]:
    """Write requests; return their ids in the same order."""
    more = {"operator": operator, "asked_by": asked_by}
    return [int(connection.execute(_ADD, {**one._asdict(), **more}).scalar_one()) for one in requests]


def begin(connection: Connection, me: Member, most: int) -> list[TakenRequest]:
    """Return the oldest requests of robots that a gateway has, each once to each of its runs."""
    rows = connection.execute(_BEGIN, {"gw": me.gw, "run": me.run, "most": most})
    return sorted(TakenRequest(*row) for row in rows)


def answer(connection: Connection, id: int, answer: str) -> None:
    """Write the answer to a request, which is JSON."""
    connection.execute(_ANSWER, {"id": id, "answer": answer})


def collect(connection: Connection, ids: Sequence[int]) -> dict[int, str]:
    """Return the answers that there are to some requests, which are done with then."""
    return dict(connection.execute(_COLLECT, {"ids": list(ids)}).all())


def withdraw(connection: Connection, ids: Sequence[int]) -> set[int]:
    """Take back those of some requests that nobody has begun to deal with; return them."""
    return set(connection.scalars(_WITHDRAW, {"ids": list(ids)}))


def forget(connection: Connection, age_s: float) -> int:
    """Delete requests that were asked more than ``age_s`` seconds ago; return how many."""
    return connection.execute(_FORGET, {"age": age_s}).rowcount
