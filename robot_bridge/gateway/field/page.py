"""``/field``: the files of the page for phones, and the site that it draws."""

from __future__ import annotations

import asyncio
import functools
import gzip
import hashlib
import http
import itertools
import json
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any, NamedTuple
from urllib.parse import urlsplit

import numpy as np
from numpy.typing import NDArray
from websockets.http11 import Request, Response

from ...core.errors import CrsError
from ...core.sites.frame import Points, SiteBounds, SiteFrame, lonlat_of
from ...core.sites.site import Site
from ..auth.port import http_response
from ..monitoring import gateway_version
from ..site.site_maps import SiteMaps

PAGE, SITE = "/field", "/field/site.json"
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".txt": "text/plain; charset=utf-8",
    ".svg": "image/svg+xml",
    ".webmanifest": "application/manifest+json",
}
INDEX = "index.html"
VERSION_MARK = b"{version}"
_WORTH_PACKING = 1000
"""bytes."""
_HOST = re.compile(r"[A-Za-z0-9.:\[\]-]+")


@dataclass
class _Content:
    kind: str
    plain: bytes

    @functools.cached_property
    def packed(self) -> bytes:
        """The same compressed: on the first request, not at the start of a gateway."""
        return gzip.compress(self.plain, mtime=0)

    @functools.cached_property
    def tag(self) -> str:
        return f'"{hashlib.sha256(self.plain).hexdigest()[:16]}"'


class FieldPage:
    """Answers requests for the page, its files and ``site.json``; the files contain no site data."""

    def __init__(self, maps: SiteMaps) -> None:
        self._maps = maps
        self._files = {
            f"{PAGE}/{file.name}": _Content(KINDS[_suffix(file.name)], _with_version(file.read_bytes()))
            for file in (resources.files(__package__) / "assets").iterdir()
            if _suffix(file.name) in KINDS
        }
        index = self._files.pop(f"{PAGE}/{INDEX}")
        self._files[PAGE] = self._files[f"{PAGE}/"] = index
        self._site: tuple[Site, _Content] | None = None
        self._making = asyncio.Lock()

    def serves(self, path: str) -> bool:
        """Return whether ``path`` belongs, or seems to belong, to the page, and the site has the page."""
        return self._maps.settings.field_page.served and (path == PAGE or path.startswith(f"{PAGE}/"))

    async def file(self, request: Request) -> Response:
        """Return a file of the page, or 404."""
        content = self._files.get(urlsplit(request.path).path)
        if content is None:
            text = f"The field page has no such file; it is at {PAGE}.\n".encode()
            return http_response(http.HTTPStatus.NOT_FOUND, text, [("Content-Type", KINDS[".txt"])])
        return await self._answer(request, content)

    async def site(self, request: Request) -> Response:
        """Return the site for drawing, or 503 with the reason why it cannot be drawn."""
        site = self._maps.site
        async with self._making:
            if self._site is None or self._site[0] is not site:
                try:
                    outline = await asyncio.to_thread(self._outline, site)
                except CrsError as error:
                    text = f"The site cannot be drawn on the earth: {error}\n".encode()
                    kind = [("Content-Type", KINDS[".txt"])]
                    return http_response(http.HTTPStatus.SERVICE_UNAVAILABLE, text, kind)
                self._site = site, outline
        return await self._answer(request, self._site[1])

    def _outline(self, site: Site) -> _Content:
        field = site.settings.field_page
        tiles = {"url": field.tiles, "attribution": field.attribution, "largest_zoom": field.largest_zoom}
        content: dict[str, Any] = {
            **site_outline(site),
            "tiles": tiles if field.tiles else None,
            "gateway": gateway_version(),
        }
        return _Content("application/json", json.dumps(content, separators=(",", ":")).encode())

    async def _answer(self, request: Request, content: _Content) -> Response:
        headers = [
            ("Content-Type", content.kind),
            ("ETag", content.tag),
            # Revalidated at each load: after an upgrade a phone has the new page at once.
            ("Cache-Control", "no-cache"),
            ("Content-Security-Policy", self._policy(request)),
            ("Referrer-Policy", "no-referrer"),
            ("Permissions-Policy", "geolocation=(self), camera=(), microphone=()"),
            ("Cross-Origin-Opener-Policy", "same-origin"),
            ("Cross-Origin-Resource-Policy", "same-origin"),
        ]
        if content.tag in request.headers.get("If-None-Match", ""):
            return http_response(http.HTTPStatus.NOT_MODIFIED, b"", headers)
        if "gzip" in request.headers.get("Accept-Encoding", "") and len(content.plain) > _WORTH_PACKING:
            # The first compression takes milliseconds, in which robots' messages would wait.
            packed = await asyncio.to_thread(getattr, content, "packed")
            return http_response(http.HTTPStatus.OK, packed, [*headers, ("Content-Encoding", "gzip")])
        return http_response(http.HTTPStatus.OK, content.plain, headers)

    def _policy(self, request: Request) -> str:
        """Return the content security policy: own files, the gateway's WebSocket, and the background map."""
        host = request.headers.get("Host", "")
        sockets = f" ws://{host} wss://{host}" if _HOST.fullmatch(host) else ""
        tiles = origin_of(self._maps.settings.field_page.tiles)
        return "; ".join(
            (
                "default-src 'none'",
                "script-src 'self'",
                "style-src 'self'",
                f"img-src 'self' data:{f' {tiles}' if tiles else ''}",
                # Older browsers do not accept 'self' for WebSockets.
                f"connect-src 'self'{sockets}",
                "manifest-src 'self'",
                "base-uri 'none'",
                "form-action 'none'",
                "frame-ancestors 'none'",
            )
        )


def origin_of(url: str) -> str:
    """Return scheme, host and port of a tile URL; empty if it has none."""
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}" if parts.netloc else ""


def _with_version(content: bytes) -> bytes:
    return content.replace(VERSION_MARK, gateway_version().encode())


def _suffix(name: str) -> str:
    return "." + name.rpartition(".")[2]


# --- The site for drawing: areas and lines in WGS 84, and the conversion of robots' positions ---

MOST_POINTS = 60_000
"""points of all drawn features: some 300 kB of transfer to a phone."""
DIGITS = 7
"""decimals of a degree: a centimetre."""
BESIDE = 0.25
"""share of the site's size on each side, within which robots are placed as accurately as on it."""
METRES_PER_DEGREE = 111_320.0
_GRID = 13
_POWERS = [(i, j) for i in range(4) for j in range(4 - i)]
"""Exponents of x and y in the terms of a cubic polynomial."""


class EarthPolynomial(NamedTuple):
    """Longitude and latitude (WGS 84, degrees) as cubic polynomials of a place in the site frame.

    With u = (x - centre[0]) / scale and v likewise, ``lon`` and ``lat`` are the coefficients of u**i * v**j
    for (i, j) = (0, 0), (0, 1), (0, 2), (0, 3), (1, 0) … (3, 0). ``within_m`` is the largest error in metres
    at places between those that the polynomials were fitted to.
    """

    centre: tuple[float, float]
    scale: float
    lon: list[float]
    lat: list[float]
    within_m: float


def earth_polynomial(frame: SiteFrame, bounds: SiteBounds) -> EarthPolynomial:
    """Return the conversion of places on and beside the site to WGS 84, as computed by a browser.

    :raises CrsError: when the site's CRS cannot be converted to WGS 84.
    """
    to_lonlat = lonlat_of(frame)
    centre = ((bounds.x_min + bounds.x_max) / 2, (bounds.y_min + bounds.y_max) / 2)
    half = np.array([bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min]) / 2 * (1 + 2 * BESIDE)
    scale = float(half.max())
    fitted = _grid(np.linspace(-1, 1, _GRID)) * half / scale
    degrees = to_lonlat(fitted * scale + centre)
    coefficients = np.linalg.lstsq(_terms(fitted), degrees, rcond=None)[0]
    between = _grid(np.linspace(-1, 1, 2 * _GRID)) * half / scale
    error = _metres(
        _terms(between) @ coefficients - to_lonlat(between * scale + centre), degrees[:, 1].mean()
    )
    return EarthPolynomial(
        centre, scale, coefficients[:, 0].tolist(), coefficients[:, 1].tolist(), float(error.max())
    )


def site_outline(site: Site) -> dict[str, Any]:
    """Return the outline of ``site`` for the field page as JSON values; places as [lon, lat] in degrees.

    Keepouts come first, then roads, surfaces and the obstacles' outlines; features beyond MOST_POINTS are
    left out, and their kinds named in ``left_out``.

    :raises CrsError: when the site's CRS cannot be converted to WGS 84.
    """
    to_lonlat = lonlat_of(site.frame)
    budget = _Budget(MOST_POINTS)

    def degrees(points: Points) -> list[list[float]]:
        rounded: list[list[float]] = np.round(to_lonlat(points), DIGITS).tolist()
        return rounded

    return {
        "id": site.id,
        "name": site.name,
        "version": site.version,
        "frame": {
            "crs": site.frame.crs,
            "origin": list(site.frame.origin),
            "rotation": site.frame.rotation,
        },
        "bounds": degrees(_rim(site.bounds)),
        "to_earth": earth_polynomial(site.frame, site.bounds)._asdict(),
        "keepouts": [
            {"name": area.label, "rings": [degrees(ring) for ring in area.rings]}
            for area in site.keepouts
            if budget.holds("keepouts", area.rings)
        ],
        "roads": [degrees(line.points) for line in site.centrelines if budget.holds("roads", [line.points])],
        "surfaces": [
            {"class": area.label, "rings": [degrees(ring) for ring in area.rings]}
            for area in site.surfaces
            if budget.holds("surfaces", area.rings)
        ],
        "obstacles": [degrees(points) for points in _obstacles(site) if budget.holds("obstacles", [points])],
        "left_out": budget.left_out,
    }


class _Budget:
    """Points that may still be drawn."""

    def __init__(self, points: int) -> None:
        self._left = points
        self.left_out: list[str] = []
        """The kinds of features left out."""

    def holds(self, kind: str, lines: Sequence[Points]) -> bool:
        """Count ``lines`` and return whether the total is within the budget."""
        self._left -= sum(map(len, lines))
        if self._left < 0 and kind not in self.left_out:
            self.left_out.append(kind)
        return self._left >= 0


def _obstacles(site: Site) -> Iterator[Points]:
    offsets = site.outlines.offsets
    if offsets[-1] > MOST_POINTS:
        # A city: robots are placed by its roads, and reading all of its outlines would take seconds.
        yield np.empty((MOST_POINTS + 1, 2))
        return
    for begin, end in itertools.pairwise(offsets):
        yield site.outlines.coordinates[begin:end]


def _rim(bounds: SiteBounds) -> Points:
    x_min, y_min, x_max, y_max = bounds
    return np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max], [x_min, y_min]])


def _grid(steps: NDArray[np.float64]) -> Points:
    across, along = np.meshgrid(steps, steps)
    return np.column_stack([across.ravel(), along.ravel()])


def _terms(places: Points) -> NDArray[np.float64]:
    return np.column_stack([places[:, 0] ** i * places[:, 1] ** j for i, j in _POWERS])


def _metres(degrees: Points, latitude: float) -> NDArray[np.float64]:
    east = degrees[:, 0] * math.cos(math.radians(latitude))
    return np.asarray(np.hypot(east, degrees[:, 1]) * METRES_PER_DEGREE, dtype=np.float64)
