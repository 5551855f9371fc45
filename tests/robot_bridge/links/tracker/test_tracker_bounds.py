"""Devices, connections and requests without end: the first are served, the others are turned away."""

from __future__ import annotations

import asyncio
import logging
from contextlib import asynccontextmanager

import pytest

from robot_bridge.links.tracker import nmea, osmand
from robot_bridge.links.tracker.adapter import (
    MOST_TRACKERS,
    SAID_OF_ONE,
    TrackerAdapter,
    TrackerSettings,
)
from robot_bridge.links.tracker.nmea import MOST_RECEIVERS, NmeaSources
from robot_bridge.links.tracker.osmand import LARGEST_BODY, HttpReports, ReportError


@pytest.fixture
def adapter():
    return TrackerAdapter(TrackerSettings(http="127.0.0.1:5055", others="phone-"), "phones.toml")


@asynccontextmanager
async def listening(serve):
    """The port on which ``serve`` deals with connections."""
    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    async with server:
        yield server.sockets[0].getsockname()[1]


def test_devices_without_end_are_not_shown(adapter):
    for number in range(MOST_TRACKERS):
        adapter._name(str(number))
    with pytest.raises(ReportError, match=f"{MOST_TRACKERS} devices are shown"):
        adapter._name("one-more")
    assert adapter._name("0") == "phone-0"


def test_what_devices_do_wrong_is_not_logged_without_end(adapter, caplog):
    with caplog.at_level(logging.WARNING):
        for _ in range(SAID_OF_ONE + 3):
            adapter.refuse("anna", ReportError("lat is x"))
        assert len(caplog.records) == SAID_OF_ONE
        for number in range(MOST_TRACKERS + 10):
            adapter.refuse(f"device {number}", ReportError("lat is x"))
    assert len(adapter._said) == MOST_TRACKERS
    assert len(caplog.records) == SAID_OF_ONE + MOST_TRACKERS - 1


def test_of_receivers_by_datagram_the_newest_are_remembered():
    sources = NmeaSources(print, print)
    for number in range(MOST_RECEIVERS + 1):
        sources.datagram(f"10.0.{number >> 8}.{number & 255}", b"")
    assert len(sources._receivers) == MOST_RECEIVERS and "10.0.0.0" not in sources._receivers


async def test_a_connection_too_many_is_turned_away(monkeypatch):
    monkeypatch.setattr(nmea, "MOST_RECEIVERS", 1)
    monkeypatch.setattr(osmand, "MOST_CONNECTIONS", 1)
    for serve, said in ((NmeaSources(print, print).serve, b""), (HttpReports(print).serve, b"HTTP/1.1 503 ")):
        async with listening(serve) as port, asyncio.timeout(30):
            _, first = await asyncio.open_connection("127.0.0.1", port)
            reader, second = await asyncio.open_connection("127.0.0.1", port)
            assert (await reader.read(13)) == said
            first.close()
            second.close()


async def test_a_body_beyond_all_bounds_is_not_read():
    async with listening(HttpReports(print).serve) as port, asyncio.timeout(30):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(f"POST / HTTP/1.1\r\nContent-Length: {LARGEST_BODY + 1}\r\n\r\n".encode())
        assert b" 413 " in await reader.readline()
        writer.close()
