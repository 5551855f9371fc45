"""JSON Schemas (draft 2020-12) of all messages, made from their classes."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection, Sequence
from typing import Any

import msgspec

from ..core.messages.administration import Gateways, SiteReport, Stopping, Suspensions
from ..core.messages.commands import CommandReport
from ..core.messages.links import Links
from ..core.messages.plans import PlanReport
from ..core.messages.positions import PositionColumns, Positions
from ..core.messages.queues import QueueReport
from ..core.messages.records import ObservationReport, PlacementReport
from ..core.messages.roads import Closures, Conflicts, ReplannedRobot
from ..core.messages.robots import PAYLOADS
from ..core.messages.safety import EmergencyReport, Geofence, Nearness

# --- The JSON Schema (draft 2020-12) of each message, from its class: types, defaults, ranges and texts

Schema = dict[str, Any]

JSON_SCHEMA = "$schema"
"""The key under which a document names the draft that it follows."""


def definitions(classes: Sequence[type], template: str, closed: Sequence[type] = ()) -> dict[str, Schema]:
    """Return the schemas of ``classes`` and of what they hold, by class name.

    ``template`` is how they refer to each other, such as ``#/$defs/{name}``. Those in ``closed``, and what
    they hold, take no properties that they do not name; but for what stops robots, which is never refused.
    """
    _, found = msgspec.json.schema_components(classes, ref_template=template)
    holders = {cls.__name__: cls for cls in classes}
    shut = _names_in(closed) - {cls.__name__ for cls in classes if getattr(cls, "stops", False)}
    return {name: _refined(schema, holders.get(name), shut) for name, schema in found.items()}


def schema_of(cls: type, *, closed: bool = False) -> Schema:
    """Return the schema of one message by itself; a ``closed`` one takes no other properties."""
    found = definitions([cls], "#/$defs/{name}", [cls] if closed else [])
    schema = found.pop(cls.__name__)
    inner = {"$defs": found} if found else {}
    return {JSON_SCHEMA: "https://json-schema.org/draft/2020-12/schema", **schema, **inner}


def plain_text(text: str) -> str:
    """Return a docstring as text for people who do not read Python."""
    text = re.sub(r":\w+:`[~.]*([^`]*)`", r"`\1`", inspect.cleandoc(text)).replace("``", "`")
    return re.sub(r"(?<!\n)\n(?!\n)", " ", text)


def _names_in(classes: Sequence[type]) -> set[str]:
    """Return the names of ``classes`` and of all that they hold."""
    return set(msgspec.json.schema_components(classes)[1]) if classes else set()


def _refined(schema: Schema, cls: type | None, closed: Collection[str]) -> Schema:
    refined = dict(schema)
    if refined.get("type") == "object" and refined.get("title") in closed:
        refined["additionalProperties"] = False
    if "description" in refined:
        refined["description"] = plain_text(refined["description"])
    properties = {name: dict(value) for name, value in schema.get("properties", {}).items()}
    for name, (least, most) in getattr(cls, "ranges", {}).items():
        _limit(properties[name], {"minimum": least, "maximum": most})
    for name, longest in getattr(cls, "texts", {}).items():
        _limit(properties[name], {"minLength": 1, "maxLength": longest})
    payload = PAYLOADS.get(refined.get("title", ""))
    if payload is not None:
        properties[payload]["description"] = "In base64; on SQL it is the row's payload, and not here."
        refined["required"] = [name for name in refined.get("required", []) if name != payload]
    return {**refined, "properties": properties} if properties else refined


def _limit(value: Schema, limits: Schema) -> None:
    """Write ``limits`` where a property says its type; null stays what it is."""
    if "anyOf" not in value:
        value.update(limits)
        return
    value["anyOf"] = [each if each.get("type") == "null" else {**each, **limits} for each in value["anyOf"]]


# --- Which class each message of the wires is, for those that no table of the messages names ---

NOTIFICATIONS: dict[str, type] = {
    "positions": Positions,
    "command": CommandReport,
    "observation": ObservationReport,
    "emergency": EmergencyReport,
    "site": SiteReport,
    "stopping": Stopping,
    "suspensions": Suspensions,
    "links": Links,
    "gateways": Gateways,
    "closures": Closures,
    "replanned": ReplannedRobot,
    "conflicts": Conflicts,
    "geofence": Geofence,
    "nearness": Nearness,
    "queue": QueueReport,
    "placement": PlacementReport,
    "plan": PlanReport,
}
"""What operators are told without asking, by method."""

HEADS: dict[str, type] = {"positions": PositionColumns}
"""The params in the JSON heads of binary frames, by method (see :mod:`..core.messages.positions`)."""
