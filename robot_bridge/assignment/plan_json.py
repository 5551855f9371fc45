"""Plans as JSON: one document with everything that a desk needs to show, change and send a plan.

Names and units are those of :mod:`.plan`; battery without a limit is ``null``.
"""

from __future__ import annotations

import json
import math
from dataclasses import fields
from typing import Any, TypeVar

from ..core.decoding import DOCUMENT, DecodingError, decode_json
from .errors import PlanFileError
from .job import Robot, Store, Target
from .plan import LeftOut, Path, Plan, PlannedTrip, RobotPlan, Stop

FORMAT, VERSION = "fleet-supervisor-assignment", 1

T = TypeVar("T")


def to_json(plan: Plan) -> str:
    """Return ``plan`` as a JSON document."""
    document = {"format": FORMAT, "version": VERSION, **_told(plan)}
    return json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def from_json(text: str | bytes) -> Plan:
    """Return the plan of a document that :func:`to_json` made.

    :raises PlanFileError: naming what is wrong and where in the document.
    """
    try:
        document = decode_json(text, DOCUMENT)
    except DecodingError as error:
        raise PlanFileError(f"This is no JSON document ({error}): choose the file of a plan.") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise PlanFileError(f"This is no plan: its format is not {FORMAT!r}. Choose the file of a plan.")
    if document.get("version") != VERSION:
        raise PlanFileError(
            f"The plan has version {document.get('version')!r}, and {VERSION} can be read: make it again."
        )
    return _plan({name: value for name, value in document.items() if name not in ("format", "version")})


def _told(value: Any) -> Any:
    if isinstance(value, Plan | RobotPlan | PlannedTrip | Stop | LeftOut | Target | Store | Robot):
        return {field.name: _told(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, tuple):
        return [_told(one) for one in value]
    if isinstance(value, float) and math.isinf(value):
        return None
    return value


def _plan(given: Any) -> Plan:
    return _made(
        Plan,
        given,
        "plan",
        robots=lambda value, at: _several(value, at, _robot_plan),
        targets=lambda value, at: _several(value, at, lambda one, where: _made(Target, one, where)),
        stores=lambda value, at: _several(value, at, lambda one, where: _made(Store, one, where)),
        left_out=lambda value, at: _several(value, at, _left_out),
    )


def _robot_plan(given: Any, at: str) -> RobotPlan:
    return _made(
        RobotPlan,
        given,
        at,
        robot=_robot,
        trips=lambda value, where: _several(value, where, _trip),
        done=lambda value, where: _several(value, where, _stop),
    )


def _robot(given: Any, at: str) -> Robot:
    return _made(Robot, given, at, range_m=_range)


def _range(given: Any, at: str) -> float:
    return math.inf if given is None else float(_checked(given, "float", at))


def _trip(given: Any, at: str) -> PlannedTrip:
    return _made(PlannedTrip, given, at, stops=lambda value, where: _several(value, where, _stop))


def _stop(given: Any, at: str) -> Stop:
    return _made(Stop, given, at, path=_path)


def _left_out(given: Any, at: str) -> LeftOut:
    return _made(LeftOut, given, at, target=lambda value, where: _made(Target, value, where))


def _path(given: Any, at: str) -> Path:
    def point(value: Any, where: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise PlanFileError(f"The plan's {where} is no point: it has to be [x, y].")
        return float(_checked(value[0], "float", where)), float(_checked(value[1], "float", where))

    points: Path = _several(given, at, point)
    return points


def _several(given: Any, at: str, one: Any) -> tuple[Any, ...]:
    if not isinstance(given, list):
        raise PlanFileError(f"The plan's {at} is no list: make the plan again.")
    return tuple(one(value, f"{at}[{k}]") for k, value in enumerate(given))


def _made(kind: type[T], given: Any, at: str, **parts: Any) -> T:
    if not isinstance(given, dict):
        raise PlanFileError(f"The plan's {at} is no object: make the plan again.")
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    wrong = sorted(set(given) ^ set(known))
    if wrong:
        problem = "is missing" if wrong[0] in known else "is not known"
        raise PlanFileError(f"{wrong[0]!r} {problem} in the plan's {at}: make the plan again.")
    return kind(
        **{
            name: (
                parts[name](given[name], f"{at}.{name}")
                if name in parts
                else _checked(given[name], str(field.type), f"{at}.{name}")
            )
            for name, field in known.items()
        }
    )


_KINDS: dict[str, tuple[type, ...]] = {"float": (int, float), "int": (int,), "str": (str,), "bool": (bool,)}


def _checked(value: Any, kind: str, at: str) -> Any:
    if not isinstance(value, _KINDS[kind]) or (isinstance(value, bool) and kind != "bool"):
        raise PlanFileError(f"The plan's {at} is {value!r}, which is no {kind}: make the plan again.")
    number: Any = value
    if kind != "float":
        return number
    try:
        finite = math.isfinite(number)
    except OverflowError:
        finite = False
    if not finite:
        raise PlanFileError(f"The plan's {at} is no finite number: make the plan again.")
    return float(number)
