"""``/field``: the files of the page for phones, and the site that it draws."""

from __future__ import annotations

import asyncio
import gzip
import hashlib
import http
import json
import re
from importlib import resources
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from ...core.errors import CrsError
from ...core.sites.site import Site
from ..monitoring.metrics import gateway_version
from ..site.site_maps import SiteMaps
from .site_outline import site_outline

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


class _Content(NamedTuple):
    kind: str
    plain: bytes
    packed: bytes
    tag: str


class FieldPage:
    """Answers requests for the page, its files and ``site.json``; nothing of the site is in the files."""

    def __init__(self, maps: SiteMaps) -> None:
        self._maps = maps
        self._files = {
            f"{PAGE}/{file.name}": _content(KINDS[_suffix(file.name)], _with_version(file.read_bytes()))
            for file in (resources.files(__package__) / "assets").iterdir()
            if _suffix(file.name) in KINDS
        }
        index = self._files.pop(f"{PAGE}/{INDEX}")
        self._files[PAGE] = self._files[f"{PAGE}/"] = index
        self._site: tuple[Site, _Content] | None = None
        self._making = asyncio.Lock()

    def serves(self, path: str) -> bool:
        """Tell whether ``path`` is the page's or looks as if it were, of a site that has the page."""
        return self._maps.settings.field_page.served and (path == PAGE or path.startswith(f"{PAGE}/"))

    def file(self, request: Request) -> Response:
        """Return a file of the page, or 404."""
        content = self._files.get(urlsplit(request.path).path)
        if content is None:
            text = f"The field page has no such file; it is at {PAGE}.\n".encode()
            return _response(http.HTTPStatus.NOT_FOUND, [("Content-Type", KINDS[".txt"])], text)
        return self._answer(request, content)

    async def site(self, request: Request) -> Response:
        """Return the site as the page draws it, or 503 with the reason why it cannot be drawn."""
        site = self._maps.site
        async with self._making:
            if self._site is None or self._site[0] is not site:
                try:
                    outline = await asyncio.to_thread(self._outline, site)
                except CrsError as error:
                    text = f"The site cannot be drawn on the earth: {error}\n".encode()
                    kind = [("Content-Type", KINDS[".txt"])]
                    return _response(http.HTTPStatus.SERVICE_UNAVAILABLE, kind, text)
                self._site = site, outline
        return self._answer(request, self._site[1])

    def _outline(self, site: Site) -> _Content:
        field = site.settings.field_page
        tiles = {"url": field.tiles, "attribution": field.attribution, "largest_zoom": field.largest_zoom}
        content: dict[str, Any] = {
            **site_outline(site),
            "tiles": tiles if field.tiles else None,
            "gateway": gateway_version(),
        }
        return _content("application/json", json.dumps(content, separators=(",", ":")).encode())

    def _answer(self, request: Request, content: _Content) -> Response:
        headers = [
            ("Content-Type", content.kind),
            ("ETag", content.tag),
            # Looked for at each load: after an upgrade a phone has the new page at once.
            ("Cache-Control", "no-cache"),
            ("Content-Security-Policy", self._policy(request)),
            ("X-Content-Type-Options", "nosniff"),
            ("Referrer-Policy", "no-referrer"),
            ("Permissions-Policy", "geolocation=(self), camera=(), microphone=()"),
            ("Cross-Origin-Opener-Policy", "same-origin"),
            ("Cross-Origin-Resource-Policy", "same-origin"),
        ]
        if content.tag in request.headers.get("If-None-Match", ""):
            return _response(http.HTTPStatus.NOT_MODIFIED, headers, b"")
        if "gzip" in request.headers.get("Accept-Encoding", "") and len(content.plain) > _WORTH_PACKING:
            return _response(http.HTTPStatus.OK, [*headers, ("Content-Encoding", "gzip")], content.packed)
        return _response(http.HTTPStatus.OK, headers, content.plain)

    def _policy(self, request: Request) -> str:
        """Return what the page may load: its own files, its gateway's WebSocket, and the background map."""
        host = request.headers.get("Host", "")
        sockets = f" ws://{host} wss://{host}" if _HOST.fullmatch(host) else ""
        tiles = origin_of(self._maps.settings.field_page.tiles)
        return "; ".join(
            (
                "default-src 'none'",
                "script-src 'self'",
                "style-src 'self'",
                f"img-src 'self' data:{f' {tiles}' if tiles else ''}",
                # Older browsers do not take 'self' for WebSockets.
                f"connect-src 'self'{sockets}",
                "manifest-src 'self'",
                "base-uri 'none'",
                "form-action 'none'",
                "frame-ancestors 'none'",
            )
        )


def origin_of(url: str) -> str:
    """Return scheme, host and port of the address of tiles; empty where it has none."""
    parts = urlsplit(url)
    return f"{parts.scheme}://{parts.netloc}" if parts.netloc else ""


def _content(kind: str, plain: bytes) -> _Content:
    tag = f'"{hashlib.sha256(plain).hexdigest()[:16]}"'
    return _Content(kind, plain, gzip.compress(plain, mtime=0), tag)


def _with_version(content: bytes) -> bytes:
    return content.replace(VERSION_MARK, gateway_version().encode())


def _response(status: http.HTTPStatus, headers: list[tuple[str, str]], body: bytes) -> Response:
    length = [("Content-Length", str(len(body)))] if status != http.HTTPStatus.NOT_MODIFIED else []
    return Response(status.value, status.phrase, Headers([*headers, *length, ("Connection", "close")]), body)


def _suffix(name: str) -> str:
    return "." + name.rpartition(".")[2]
