"""Plans in the database: each written whole when it changes, with the stops that are tasks of queues."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Collection, Iterable, Sequence
from typing import Any

from sqlalchemy import Connection, delete, insert, select, update

from ...core.assignment.plan import ConePlan, plan_from_json, plan_to_json, stop_document, stop_of_document
from ...core.assignment.progress import ConeFacts, SentStop
from ...core.errors import PlanFileError, RefusedError
from ...core.json_decoder import DOCUMENT, decode_json
from ...core.messages.plans import PlanState
from ..storage.rows import readable
from ..storage.schema import plan_stops, plans
from .model import ENDS, DrivenPlan, PlanTerms

_ENDED = [state.value for state in ENDS]


class PlanMovedError(RefusedError):
    """A plan is not stored as it was taken for: another gateway has changed it. Nothing is written."""


def open_revisions(connection: Connection) -> dict[str, int]:
    """Return at which revision each plan is that is driven, the oldest plan first."""
    c = plans.c
    query = select(c.name, c.revision).where(c.state.not_in(_ENDED)).order_by(c.submitted_at)
    return dict(connection.execute(query).all())


def find_plan(connection: Connection, name: str) -> DrivenPlan | None:
    """Return one plan, driven or ended."""
    return next(iter(_read(connection, select(plans).where(plans.c.name == name))), None)


def newest_ended_plans(connection: Connection, limit: int) -> list[DrivenPlan]:
    """Return the plans that ended, newest first."""
    query = select(plans).where(plans.c.state.in_(_ENDED)).order_by(plans.c.ended_at.desc()).limit(limit)
    return _read(connection, query)


def load_stops(connection: Connection, name: str) -> list[SentStop]:
    """Return the stops of a plan in the order in which they were sent."""
    query = select(plan_stops).where(plan_stops.c.plan == name).order_by(plan_stops.c.place)
    return list(readable(connection.execute(query).mappings(), _stop, lambda row: f"stop {row['task']}"))


def add_plan(
    connection: Connection, plan: DrivenPlan, stops: Sequence[SentStop], beside: Collection[str]
) -> None:
    """Write a new plan with its stops.

    :raises PlanMovedError: when others are driven by now than those ``beside`` it, or it is stored already:
        nothing may be written then.
    """
    if not open_revisions(connection).keys() <= {*beside}:
        raise PlanMovedError("another plan was submitted meanwhile; look at the plans again")
    save_plan(connection, plan, stops)


def save_plan(
    connection: Connection,
    plan: DrivenPlan,
    new: Sequence[SentStop] = (),
    gone: Sequence[str] = (),
    place: int = 0,
) -> None:
    """Write a plan, its ``new`` stops from ``place`` on, and delete those of the tasks that are ``gone``.

    :raises PlanMovedError: when what is stored is not the revision before: nothing may be written then.
    """
    found = connection.scalar(select(plans.c.revision).where(plans.c.name == plan.name).with_for_update())
    if found != (plan.revision - 1 or None):
        raise PlanMovedError(f"plan {plan.name!r} was changed meanwhile; look at it again")
    if found is None:
        connection.execute(insert(plans).values(name=plan.name, **_row(plan)))
    else:
        connection.execute(update(plans).where(plans.c.name == plan.name).values(_row(plan)))
    for begin in range(0, len(gone), 500):
        connection.execute(delete(plan_stops).where(plan_stops.c.task.in_(gone[begin : begin + 500])))
    rows = [
        {
            "task": one.task,
            "plan": plan.name,
            "robot": one.robot,
            "place": place + k,
            "number": one.number,
            "content": json.dumps(stop_document(one.stop)),
        }
        for k, one in enumerate(new)
    ]
    if rows:
        connection.execute(insert(plan_stops), rows)


def _read(connection: Connection, query: Any) -> list[DrivenPlan]:
    rows: Iterable[Any] = connection.execute(query).mappings()
    return list(readable(rows, _plan, lambda row: f"plan {row['name']}"))


def _row(plan: DrivenPlan) -> dict[str, Any]:
    return {
        "revision": plan.revision,
        "state": plan.state.value,
        "submitted_by": plan.submitted_by,
        "submitted_at": plan.submitted_at,
        "by_itself": int(plan.by_itself),
        "content": json.dumps(dataclasses.asdict(plan.terms)),
        "document": plan_to_json(plan.document),
        "proposal": None if plan.proposal is None else plan_to_json(plan.proposal),
        "held": json.dumps(dict(plan.held)),
        "reason": plan.reason,
        "by": plan.by,
        "at": plan.at,
        "ended_at": plan.ended_at,
        "try_again": int(plan.try_again),
        "meetings": plan.meetings,
        "closed": plan.closed,
    }


def _document(text: str) -> ConePlan:
    try:
        return plan_from_json(text)
    except PlanFileError as error:
        raise ValueError(str(error)) from error


def _plan(row: Any) -> DrivenPlan:
    content = decode_json(row["content"], DOCUMENT)
    cones = {name: ConeFacts(**facts) for name, facts in content.pop("cones").items()}
    stand = [(x, y) for x, y in content.pop("stand")]
    return DrivenPlan(
        name=row["name"],
        document=_document(row["document"]),
        terms=PlanTerms(cones, stand, **content),
        submitted_by=row["submitted_by"],
        submitted_at=row["submitted_at"],
        by_itself=bool(row["by_itself"]),
        state=PlanState(row["state"]),
        revision=row["revision"],
        proposal=None if row["proposal"] is None else _document(row["proposal"]),
        held=decode_json(row["held"], DOCUMENT),
        reason=row["reason"],
        by=row["by"],
        at=row["at"],
        ended_at=row["ended_at"],
        try_again=bool(row["try_again"]),
        meetings=row["meetings"],
        closed=row["closed"],
    )


def _stop(row: Any) -> SentStop:
    try:
        stop = stop_of_document(decode_json(row["content"], DOCUMENT))
    except PlanFileError as error:
        raise ValueError(str(error)) from error
    return SentStop(row["robot"], row["number"], stop, row["task"])
