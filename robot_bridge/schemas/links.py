"""What goes over ``/link``: the messages of robots, with ``robot`` among the params, and a link's own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..messages import ANSWERS, REQUESTS, ROBOT_NAME, OpAck, SendGPS, SendPos, Start
from ..messages.links import (
    AbortOfAll,
    GetAreas,
    LinkColumns,
    LinkHello,
    LinkPositions,
    LinkStatus,
    LinkWelcome,
    Released,
    SiteAreas,
)
from ..messages.results import Done
from ..messages.service import Playback, PlaybackReport
from .definitions import JSON_SCHEMA, Schema, definitions, schema_of
from .frames import call, calls, channel, error, in_columns, message, news, operation, result, results

CALLS: dict[str, type] = {cls.method: cls for cls in (LinkHello, LinkStatus, GetAreas)}
"""What a link calls for itself, by method."""
ROBOT_CALLS: dict[str, type] = {op: cls for op, cls in REQUESTS.items() if op != "OpAck"}
"""What a link calls for a robot of its own, by method."""
ROBOT_ANSWERS: dict[str, type] = {op: cls for op, cls in ANSWERS.items() if op not in ("OpAck", "Start")}
"""What a robot of a link is told, by method."""
OF_ROBOT = "OfRobot"
"""The end of the names of schemas with ``robot``."""
_RESULTS: dict[str, type] = {
    "helloResult": LinkWelcome,
    "statusResult": Done,
    "get_areasResult": SiteAreas,
}
_STOP = "AbortOfAll"
_PLAYBACK_RESULT = f"{Playback.method}Result"
_ROBOT: Schema = {
    "type": "string",
    "pattern": f"^{ROBOT_NAME.pattern}$",
    "description": "The robot that this is about.",
}


def link_documents() -> dict[str, Schema]:
    """Return the JSON Schemas by path: ``link`` holds what links say, ``link-gateway`` what they are told."""
    said = {f"link/{op}.json": _with_robot(schema_of(cls, closed=True)) for op, cls in ROBOT_CALLS.items()}
    said |= {f"link/{method}.json": schema_of(cls, closed=True) for method, cls in CALLS.items()}
    positions = [_with_robot(schema_of(cls, closed=True)) for cls in (SendPos, SendGPS)]
    said["link/positions.json"] = _with_entries(schema_of(LinkPositions), positions)
    said["head/link-positions.json"] = schema_of(LinkColumns)
    told = {f"link-gateway/{op}.json": _with_robot(schema_of(cls)) for op, cls in ROBOT_ANSWERS.items()}
    told |= {f"link-gateway/{cls.__name__}.json": schema_of(cls) for cls in (Start, Released, AbortOfAll)}
    told[f"link-gateway/{Playback.method}.json"] = schema_of(Playback)
    said[f"link/{_PLAYBACK_RESULT}.json"] = schema_of(PlaybackReport)
    told |= {f"link-gateway/{name}.json": schema_of(cls) for name, cls in _RESULTS.items()}
    return {**said, **told}


def link_schemas(template: str) -> dict[str, Schema]:
    """Return the schemas of the AsyncAPI document; ``template`` is how they refer to each other."""
    own: list[type] = [*CALLS.values(), LinkPositions, LinkColumns, *_RESULTS.values(), Released, AbortOfAll]
    own += [Playback, PlaybackReport]
    robots: list[type] = [*ROBOT_CALLS.values(), *ROBOT_ANSWERS.values()]
    found = definitions(robots, template, list(ROBOT_CALLS.values()))
    with_robot = {f"{cls.__name__}{OF_ROBOT}": _with_robot(found[cls.__name__]) for cls in robots}
    schemas = {**definitions(own, template, list(CALLS.values())), **with_robot}
    entries = [{"$ref": template.format(name=f"{cls.__name__}{OF_ROBOT}")} for cls in (SendPos, SendGPS)]
    schemas["LinkPositions"] = _with_entries(schemas["LinkPositions"], entries)
    return schemas


def link_channel() -> Schema:
    """Return the endpoint with its messages."""
    positions = {LinkPositions.method: LinkPositions}
    told = {"Start": Start, "Released": Released}
    messages = {
        **calls(CALLS),
        **calls(ROBOT_CALLS, OF_ROBOT),
        **calls(ROBOT_ANSWERS, OF_ROBOT),
        **results(_RESULTS),
        **news({**positions, **told}),
        **in_columns({LinkPositions.method: LinkColumns}),
        **calls({Playback.method: Playback}),
        **results({_PLAYBACK_RESULT: PlaybackReport}),
        _STOP: message(_STOP, AbortOfAll, call(AbortOfAll.method, _STOP, with_id=False)),
        "OpAck": result(OpAck),
        "error": error(),
    }
    query = {"link": "The link's name, where it has no token."}
    return channel("/link", "A connection that speaks for many robots.", messages, query)


def link_operations() -> Schema:
    """Return what the gateway receives of links and sends them, each with what answers it."""
    acknowledged = ("OpAck", "error")
    positions = [LinkPositions.method, f"{LinkPositions.method}InColumns"]
    return {
        **{
            f"link.{name}": operation("receive", "link", [name], (f"{name}Result", "error")) for name in CALLS
        },
        **{f"link.robot.{op}": operation("receive", "link", [op], acknowledged) for op in ROBOT_CALLS},
        **{f"link.gateway.{op}": operation("send", "link", [op], acknowledged) for op in ROBOT_ANSWERS},
        "link.positions": operation("receive", "link", positions),
        "link.Start": operation("send", "link", ["Start"]),
        "link.Released": operation("send", "link", ["Released"]),
        f"link.{Playback.method}": operation("send", "link", [Playback.method], (_PLAYBACK_RESULT, "error")),
        f"link.{_STOP}": operation("send", "link", [_STOP], acknowledged),
    }


def _with_robot(schema: Mapping[str, Any]) -> Schema:
    """Return the schema of a message of a robot for a connection that many robots share."""
    properties = {"robot": _ROBOT, **schema.get("properties", {})}
    return {**schema, "properties": properties, "required": ["robot", *schema.get("required", [])]}


def _with_entries(schema: Schema, entries: list[Schema]) -> Schema:
    """Return the schema of LinkPositions with those of what a position is."""
    inner = [{name: value for name, value in entry.items() if name != JSON_SCHEMA} for entry in entries]
    return {**schema, "properties": {"positions": {"type": "array", "items": {"anyOf": inner}}}}
