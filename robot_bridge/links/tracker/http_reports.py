"""The HTTP server that phones report to: small requests, answered at once, each bounded in size and time."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable
from urllib.parse import urlsplit

from .osmand import Report, ReportError, reports_in_form, reports_in_json

log = logging.getLogger(__name__)

MOST_CONNECTIONS = 500
REQUEST_WITHIN = 15.0
"""seconds for a request, from its first byte to its last, and for the next one on the same connection."""
LARGEST_HEAD = 16 << 10
LARGEST_BODY = 256 << 10

Accept = Callable[[Report], None]
"""Takes a report; raises ReportError for one that counts for nothing."""


class RequestError(Exception):
    """A request that is not dealt with, and the connection is closed behind the answer."""

    def __init__(self, status: str, text: str) -> None:
        super().__init__(text)
        self.status = status


class HttpReports:
    """Answers phones: 200 for a report that is shown, 400 with the reason for one that is not."""

    def __init__(self, accept: Accept) -> None:
        self._accept = accept
        self._open = 0

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one connection to its end."""
        self._open += 1
        try:
            if self._open > MOST_CONNECTIONS:
                await _answer(writer, "503 Service Unavailable", "too many connections", goes_on=False)
                return
            while await self._request(reader, writer):
                pass
        except (OSError, EOFError, TimeoutError, ValueError):
            # It went away in the middle of a request, or never ended one.
            return
        finally:
            self._open -= 1
            writer.close()
            with contextlib.suppress(OSError):
                await writer.wait_closed()

    async def _request(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> bool:
        """Deal with one request; return whether the client may send another."""
        try:
            async with asyncio.timeout(REQUEST_WITHIN):
                method, target, headers = _head(await _head_of(reader))
                body = await reader.readexactly(_length(headers))
            for report in _reports(method, target, headers, body):
                self._accept(report)
        except RequestError as error:
            await _answer(writer, error.status, str(error), goes_on=False)
            return False
        except ReportError as error:
            goes_on = headers.get("connection", "").lower() != "close"
            await _answer(writer, "400 Bad Request", str(error), goes_on=goes_on)
            return goes_on
        goes_on = headers.get("connection", "").lower() != "close"
        await _answer(writer, "200 OK", "", goes_on=goes_on)
        return goes_on


async def _head_of(reader: asyncio.StreamReader) -> bytes:
    try:
        return await reader.readuntil(b"\r\n\r\n")
    except asyncio.LimitOverrunError:
        raise RequestError("431 Request Header Fields Too Large", "the request is too large") from None


def _head(head: bytes) -> tuple[str, str, dict[str, str]]:
    lines = head.decode("latin-1").split("\r\n")
    parts = lines[0].split(" ")
    if len(parts) != 3 or not parts[2].startswith("HTTP/1."):
        raise RequestError("400 Bad Request", "this is no HTTP request")
    headers = {}
    for line in lines[1:]:
        name, colon, value = line.partition(":")
        if colon:
            headers[name.strip().lower()] = value.strip()
    if parts[2] == "HTTP/1.0":
        headers.setdefault("connection", "close")
    return parts[0], parts[1], headers


def _length(headers: dict[str, str]) -> int:
    if "transfer-encoding" in headers:
        raise RequestError("411 Length Required", "say how long the body is (Content-Length)")
    text = headers.get("content-length", "0")
    if not (text.isascii() and text.isdigit() and len(text) < 12):
        raise RequestError("400 Bad Request", "Content-Length is no number")
    if int(text) > LARGEST_BODY:
        raise RequestError("413 Content Too Large", f"a body has at most {LARGEST_BODY} bytes")
    return int(text)


def _reports(method: str, target: str, headers: dict[str, str], body: bytes) -> list[Report]:
    if method not in ("GET", "POST"):
        raise RequestError("405 Method Not Allowed", "report with GET or POST")
    try:
        query = urlsplit(target).query
    except ValueError:
        raise RequestError("400 Bad Request", "the address cannot be read") from None
    if method == "POST" and (headers.get("content-type", "").startswith("application/json")):
        return reports_in_json(body)
    return reports_in_form(query or body.decode("utf-8", "replace"))


async def _answer(writer: asyncio.StreamWriter, status: str, text: str, *, goes_on: bool) -> None:
    content = f"{text}\n".encode() if text else b""
    head = (
        f"HTTP/1.1 {status}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {len(content)}\r\n"
        f"Connection: {'keep-alive' if goes_on else 'close'}\r\n\r\n"
    )
    writer.write(head.encode() + content)
    async with asyncio.timeout(REQUEST_WITHIN):
        await writer.drain()
