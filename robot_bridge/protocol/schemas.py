"""JSON Schemas (draft 2020-12) of all messages, from their classes; OpenAPI of the queries over HTTP."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import msgspec

from ..core.messages.administration import PROTOCOL_VERSION, Gateways, SiteReport, Stopping, Suspensions
from ..core.messages.base import CRS_CODE, ROBOT_NAME
from ..core.messages.commands import CommandReport
from ..core.messages.links import Links
from ..core.messages.plans import PlanReport
from ..core.messages.positions import PositionColumns, Positions
from ..core.messages.queues import QueueReport
from ..core.messages.records import ObservationReport, PlacementReport
from ..core.messages.roads import Closures, Conflicts, ReplannedRobot, RouteReport, SurfaceAt
from ..core.messages.robots import PAYLOADS
from ..core.messages.safety import EmergencyReport, Geofence, Nearness

# --- The JSON Schema (draft 2020-12) of each message, from its class: types, defaults, ranges and texts

Schema = dict[str, Any]

JSON_SCHEMA = "$schema"
"""The key under which a document names the draft that it follows."""


def definitions(classes: Sequence[type], template: str, closed: Sequence[type] = ()) -> dict[str, Schema]:
    """Return the schemas of ``classes`` and of the classes nested in them, by class name.

    ``template`` is how they refer to each other, such as ``#/$defs/{name}``. Those in ``closed``, and the
    classes nested in them, allow no further properties, except requests that stop robots, which are never
    refused.
    """
    _, found = msgspec.json.schema_components(classes, ref_template=template)
    holders = {cls.__name__: cls for cls in classes}
    shut = _names_in(closed) - {cls.__name__ for cls in classes if getattr(cls, "stops", False)}
    return {name: _refined(schema, holders.get(name), shut) for name, schema in found.items()}


def schema_of(cls: type, *, closed: bool = False) -> Schema:
    """Return the schema of one message by itself; a ``closed`` one allows no other properties."""
    found = definitions([cls], "#/$defs/{name}", [cls] if closed else [])
    schema = found.pop(cls.__name__)
    inner = {"$defs": found} if found else {}
    return {JSON_SCHEMA: "https://json-schema.org/draft/2020-12/schema", **schema, **inner}


def plain_text(text: str) -> str:
    """Return a docstring as plain text, without Python's markup."""
    text = re.sub(r":\w+:`[~.]*([^`]*)`", r"`\1`", inspect.cleandoc(text)).replace("``", "`")
    return re.sub(r"(?<!\n)\n(?!\n)", " ", text)


def _names_in(classes: Sequence[type]) -> set[str]:
    """Return the names of ``classes`` and of all classes nested in them."""
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
    """Write ``limits`` beside the type of a property; null stays unlimited."""
    if "anyOf" not in value:
        value.update(limits)
        return
    value["anyOf"] = [each if each.get("type") == "null" else {**each, **limits} for each in value["anyOf"]]


# --- Classes of the messages that are in no table of the message modules ---

NOTIFICATIONS: dict[str, type] = {
    "positions": Positions,
    "command": CommandReport,
    "observation": ObservationReport,
    "emergency": EmergencyReport,
    "site": SiteReport,
    "stopping": Stopping,
    "suspensions": Suspensions,
    "links": Links,
    Gateways.method: Gateways,
    "closures": Closures,
    "replanned": ReplannedRobot,
    "conflicts": Conflicts,
    "geofence": Geofence,
    "nearness": Nearness,
    "queue": QueueReport,
    "placement": PlacementReport,
    "plan": PlanReport,
}
"""Notifications to operators, by method."""

HEADS: dict[str, type] = {"positions": PositionColumns}
"""The params in the JSON heads of binary frames, by method (see :mod:`..core.messages.positions`)."""


# --- The OpenAPI document of the queries over HTTP: road surfaces at places, and routes along roads ---

SURFACES, ROUTE = "/site/surfaces", "/site/route"
SITE_FRAME = "site"
"""The value of ``crs`` for places in metres in the site frame."""
DEGREES = "EPSG:4326"
GEOJSON, PROBLEM = "application/geo+json", "application/problem+json"
MOST_PLACES = 140
"""points in a URL, which may have 8 kB in all."""
MOST_SURFACES = 20
_NUMBER = r"[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]{1,2})?"
PLACE = {"type": "string", "pattern": f"^{_NUMBER},{_NUMBER}$", "maxLength": 48}


@dataclass(frozen=True)
class QueryParameter:
    """A query parameter of a URL: its JSON Schema, and its purpose.

    If its schema is an array, each value is a parameter of its own: ``point=1,2&point=3,4``.
    """

    name: str
    schema: Schema
    text: str
    required: bool = False

    @property
    def is_repeated(self) -> bool:
        """Whether it may be repeated."""
        return bool(self.schema["type"] == "array")


CRS = QueryParameter(
    "crs",
    {"type": "string", "default": DEGREES, "pattern": f"^({CRS_CODE.pattern}|{SITE_FRAME})$"},
    f"Coordinate reference system of the places, such as EPSG:32633; {SITE_FRAME} for metres in the site "
    "frame. x (longitude, easting) comes before y whatever the CRS.",
)
PARAMETERS: dict[str, tuple[QueryParameter, ...]] = {
    SURFACES: (
        QueryParameter(
            "point",
            {
                "type": "array",
                "items": PLACE,
                "minItems": 1,
                "maxItems": MOST_PLACES,
            },
            "A place as x,y.",
            required=True,
        ),
        CRS,
    ),
    ROUTE: (
        QueryParameter("start", PLACE, "Where the way begins, as x,y; or give robot."),
        QueryParameter(
            "robot",
            {"type": "string", "pattern": f"^{ROBOT_NAME.pattern}$"},
            "Whose way it is, from where that robot is now.",
        ),
        QueryParameter("goal", PLACE, "Where the way ends, as x,y.", required=True),
        CRS,
        QueryParameter(
            "fastest", {"type": "boolean", "default": False}, "The fastest way in place of the shortest."
        ),
        QueryParameter("least_width", {"type": "number", "default": 0}, "Metres that a road has at least."),
        QueryParameter(
            "surface",
            {"type": "array", "items": {"type": "string", "maxLength": 64}, "maxItems": MOST_SURFACES},
            "A class of road surface that may be used, such as asphalt; all where none is named.",
        ),
        QueryParameter(
            "avoid_reserved",
            {"type": "boolean", "default": False},
            "Leave out roads on which the tasks of other robots lead.",
        ),
    ),
}


def openapi() -> Schema:
    """Return the document."""
    schemas = definitions([RouteReport, SurfaceAt], "#/components/schemas/{name}")
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "Site queries of the fleet gateway",
            "version": str(PROTOCOL_VERSION),
            "description": "Which road surface is at a place, and the way along the roads between two. "
            "Answers are GeoJSON in WGS 84, which GIS programs open by the address.",
        },
        "security": [{"token": []}],
        "paths": {
            SURFACES: {
                "get": _operation(
                    "surfaces",
                    "The road surface at each place, as points in the order asked.",
                    SURFACES,
                    _collection("Point", _point_properties()),
                )
            },
            ROUTE: {
                "get": _operation(
                    "route",
                    "The way along the roads, as one line.",
                    ROUTE,
                    _collection("LineString", _route_properties(schemas["RouteReport"])),
                )
            },
        },
        "components": {
            "schemas": schemas | {"Problem": _PROBLEM},
            "securitySchemes": {
                "token": {
                    "type": "http",
                    "scheme": "bearer",
                    "description": "An operator's token, of any role. None is needed on the gateway's own "
                    "computer while the site has no accounts.",
                }
            },
        },
    }


_PROBLEM: Schema = {
    "type": "object",
    "description": "Why there is no answer (RFC 9457).",
    "properties": {
        "title": {"type": "string"},
        "status": {"type": "integer"},
        "detail": {"type": "string", "description": "What was wrong, and what to do."},
    },
    "required": ["title", "status", "detail"],
}
_FAULTS = {
    "400": "A parameter is missing, unknown or cannot be read.",
    "422": "The site has no answer to that: no road is near, no way leads there, a place lies elsewhere.",
    "503": "Too much is asked at once, or the site cannot be placed on the earth.",
}


def _operation(name: str, text: str, path: str, answer: Schema) -> Schema:
    problem = {"schema": {"$ref": "#/components/schemas/Problem"}}
    return {
        "operationId": name,
        "summary": text,
        "parameters": [
            {
                "name": one.name,
                "in": "query",
                "required": one.required,
                "description": one.text,
                "schema": one.schema,
                **({"style": "form", "explode": True} if one.is_repeated else {}),
            }
            for one in PARAMETERS[path]
        ],
        "responses": {
            "200": {"description": text, "content": {GEOJSON: {"schema": answer}}},
            "401": {"description": "No token that holds.", "content": {"text/plain": {}}},
            **{
                status: {"description": why, "content": {PROBLEM: problem}} for status, why in _FAULTS.items()
            },
        },
    }


def _collection(geometry: str, properties: Schema) -> Schema:
    """Return the schema of a GeoJSON FeatureCollection (RFC 7946) whose features have such geometries."""
    feature: dict[str, Any] = {
        "type": {"const": "Feature"},
        "geometry": {
            "type": "object",
            "properties": {"type": {"const": geometry}, "coordinates": {"type": "array"}},
            "required": ["type", "coordinates"],
        },
        "properties": properties,
    }
    features = {"type": "object", "properties": feature, "required": list(feature)}
    return {
        "type": "object",
        "properties": {
            "type": {"const": "FeatureCollection"},
            "features": {"type": "array", "items": features},
        },
        "required": ["type", "features"],
    }


def _point_properties() -> Schema:
    return {
        "anyOf": [
            {"$ref": "#/components/schemas/SurfaceAt"},
            {
                "type": "object",
                "description": "Where there is no road surface.",
                "properties": {"surface": {"type": "null"}},
                "required": ["surface"],
            },
        ]
    }


def _route_properties(route: Schema) -> Schema:
    """Return the properties of a route: all of ``route`` but its points, which are the geometry."""
    kept = {name: value for name, value in route["properties"].items() if name not in ("points", "tight")}
    return {"type": "object", "properties": kept, "required": ["metres", "seconds"]}
