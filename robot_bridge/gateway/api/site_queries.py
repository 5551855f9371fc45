"""``/site/surfaces`` and ``/site/route``: questions on the site over HTTP, answered as GeoJSON."""

from __future__ import annotations

import asyncio
import http
import json
import re
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import numpy as np
from websockets.http11 import Request, Response

from ...core.errors import CrsError, RefusedError
from ...core.messages.validation import MessageError
from ...core.sites.frame import lonlat_of
from ...protocol.codec import decode_desk_request
from ...protocol.openapi import (
    DEGREES,
    GEOJSON,
    PARAMETERS,
    PLACE,
    PROBLEM,
    ROUTE,
    SITE_FRAME,
    QueryParameter,
)
from ..auth.port import http_response
from ..model.request_handlers import RequestHandlers
from ..site.site_maps import SiteMaps

MOST_AT_ONCE = 8
"""Questions under way; a way through a city can take a second."""
MOST_FIELDS = 2_000
"""Parameters behind one ``?``, with their repetitions; the line of a request ends at 8 kB before."""
DIGITS = 7
"""Decimals of a degree: a centimetre."""
_NAMES = {"point": "points", "surface": "surfaces"}
"""What the desk's requests call a parameter that is repeated here."""

Places = list[list[float]]


class SiteQueries:
    """Answers questions by the services that answer the same ones of desks."""

    def __init__(self, maps: SiteMaps, handlers: RequestHandlers) -> None:
        self._maps, self._handlers = maps, handlers
        self._under_way = 0

    def serves(self, path: str) -> bool:
        """Tell whether ``path`` is one of theirs."""
        return path in PARAMETERS

    async def answer(self, request: Request) -> Response:
        """Return GeoJSON, or a problem that says what was wrong and what to do."""
        if self._under_way >= MOST_AT_ONCE:
            return _problem(
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                f"{MOST_AT_ONCE} questions are being answered; ask again in a second.",
                [("Retry-After", "1")],
            )
        parts = urlsplit(request.path)
        self._under_way += 1
        try:
            query = read_query(parts.query, PARAMETERS[parts.path])
            features = await (self._route if parts.path == ROUTE else self._surfaces)(query)
        except MessageError as error:
            return _problem(http.HTTPStatus.BAD_REQUEST, _text(parts.path, error))
        except RefusedError as error:
            return _problem(http.HTTPStatus.UNPROCESSABLE_ENTITY, _text(parts.path, error))
        except CrsError as error:
            text = f"The site cannot be placed on the earth: {error}"
            return _problem(http.HTTPStatus.SERVICE_UNAVAILABLE, text)
        finally:
            self._under_way -= 1
        content = {"type": "FeatureCollection", "features": features}
        return _response(http.HTTPStatus.OK, GEOJSON, json.dumps(content, allow_nan=False).encode())

    async def _surfaces(self, query: dict[str, Any]) -> list[dict[str, Any]]:
        asked = decode_desk_request("get_surface", query)
        found = (await self._handlers.answer(asked, ""))["surfaces"]
        degrees = await asyncio.to_thread(self._on_earth, query["points"], query.get("crs"))
        return [
            _feature("Point", place, {"surface": None} if surface is None else surface)
            for place, surface in zip(degrees, found, strict=True)
        ]

    async def _route(self, query: dict[str, Any]) -> list[dict[str, Any]]:
        query["x"], query["y"] = query.pop("goal")
        found = await self._handlers.answer(decode_desk_request("get_route", query), "")
        if not found["engine"]:
            # A desk is shown the straight line with its note; a program would take it for a road.
            raise RefusedError(f"there is no way along the roads: {found['note'].partition(': ')[2]}")
        line = await asyncio.to_thread(self._on_earth, found.pop("points"), None)
        found.pop("tight", None)
        return [_feature("LineString", line, found)]

    def _on_earth(self, places: Sequence[Sequence[float]], crs: str | None) -> Places:
        """Return places of ``crs``, or of the site frame, as longitudes and latitudes.

        :raises RefusedError, CrsError: when the places, or the site, have none.
        """
        pairs = [(x, y) for x, y in places]
        here = pairs if crs is None else self._maps.to_site(pairs, crs)
        degrees = lonlat_of(self._maps.site.frame)(np.array(here))
        if not np.isfinite(degrees).all():
            raise RefusedError("a place lies nowhere on the earth; give places of this site")
        # Without the sign of a zero.
        found: Places = (degrees.round(DIGITS) + 0.0).tolist()
        return found


def read_query(text: str, parameters: Sequence[QueryParameter]) -> dict[str, Any]:
    """Return what stands behind the ``?`` of an address, by the names of the desk's requests.

    :raises MessageError: for what is unknown, missing, there twice or no value of its kind.
    """
    known = {one.name: one for one in parameters}
    found: dict[str, Any] = {}
    try:
        pairs = parse_qsl(text, keep_blank_values=True, errors="strict", max_num_fields=MOST_FIELDS)
    except ValueError as error:
        raise MessageError(f"what stands behind the ? cannot be read: {error}") from None
    for name, value in pairs:
        if (one := known.get(name)) is None:
            raise MessageError(f"unknown parameter {name[:40]!r}; known are {', '.join(known)}")
        key = _NAMES.get(name, name)
        if one.is_repeated:
            found.setdefault(key, []).append(_value(name, value, one.schema["items"]))
            if len(found[key]) > (most := one.schema["maxItems"]):
                raise MessageError(f"{name} is there more than {most} times; ask in parts")
        elif key in found:
            raise MessageError(f"{name} is there twice; give it once")
        else:
            found[key] = _value(name, value, one.schema)
    if missing := [
        one.name for one in parameters if one.required and _NAMES.get(one.name, one.name) not in found
    ]:
        raise MessageError(f"{missing[0]} is missing; give {missing[0]}=…")
    if found.setdefault("crs", DEGREES) == SITE_FRAME:
        del found["crs"]
    return found


def _value(name: str, text: str, schema: Mapping[str, Any]) -> Any:
    if schema["type"] == "boolean":
        if text not in ("true", "false"):
            raise MessageError(f"{name} is {text[:40]!r}; give true or false")
        return text == "true"
    if schema["type"] == "number":
        return _numbers(name, text, 1)[0]
    longest = schema.get("maxLength")
    if longest is not None and len(text) > longest:
        raise MessageError(f"{name} has {len(text)} characters; at most {longest} are taken")
    return _numbers(name, text, 2) if schema is PLACE else text


def _numbers(name: str, text: str, count: int) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise MessageError(f"{name} is {text[:40]!r}; give {'a number' if count == 1 else 'x,y'}")
    return numbers


def _feature(kind: str, coordinates: Any, properties: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "type": "Feature",
        "geometry": {"type": kind, "coordinates": coordinates},
        "properties": dict(properties),
    }


def _text(path: str, error: Exception) -> str:
    """Return what was wrong, under the name that the question has here."""
    return f"{path}: {re.sub(r'get_(surface|route): ', '', str(error))}"


def _problem(status: http.HTTPStatus, detail: str, headers: Sequence[tuple[str, str]] = ()) -> Response:
    content = {"title": status.phrase, "status": status.value, "detail": detail}
    return _response(status, PROBLEM, json.dumps(content).encode(), headers)


def _response(
    status: http.HTTPStatus, kind: str, body: bytes, headers: Sequence[tuple[str, str]] = ()
) -> Response:
    fixed = [("Content-Type", kind), ("Cache-Control", "no-store")]
    return http_response(status, body, [*fixed, *headers])
