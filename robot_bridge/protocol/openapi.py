"""OpenAPI document of the questions over HTTP: road surfaces at places, and ways along the roads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..core.messages.administration import PROTOCOL_VERSION
from ..core.messages.base import CRS_CODE, ROBOT_NAME
from ..core.messages.roads import RouteReport, SurfaceAt
from .json_schemas import Schema, definitions

SURFACES, ROUTE = "/site/surfaces", "/site/route"
SITE_FRAME = "site"
"""What stands for ``crs`` where places are metres in the site frame."""
DEGREES = "EPSG:4326"
GEOJSON, PROBLEM = "application/geo+json", "application/problem+json"
MOST_PLACES = 140
"""points in an address, which may have 8 kB in all."""
MOST_SURFACES = 20
_NUMBER = r"[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]{1,2})?"
PLACE = {"type": "string", "pattern": f"^{_NUMBER},{_NUMBER}$", "maxLength": 48}


@dataclass(frozen=True)
class QueryParameter:
    """A parameter behind the ``?`` of an address: its JSON Schema, and what it is for.

    Of one whose schema is an array each value stands by itself: ``point=1,2&point=3,4``.
    """

    name: str
    schema: Schema
    text: str
    required: bool = False

    @property
    def is_repeated(self) -> bool:
        """Whether it may be there several times."""
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
    """Return the properties of a way: all of ``route`` but its places, which are the geometry."""
    kept = {name: value for name, value in route["properties"].items() if name not in ("points", "tight")}
    return {"type": "object", "properties": kept, "required": ["metres", "seconds"]}
