"""What is kept for a time only, on each kind of database: it goes in time, in pieces, and nothing else."""

import asyncio
import json
from dataclasses import replace
from types import SimpleNamespace

import pytest
from sqlalchemy import func, insert, select

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.robots import Abort, OpAck, SendPos, SetPosEnd
from robot_bridge.core.sites.settings_tables import (
    AuditSettings,
    CommandSettings,
    LimitSettings,
    ObservationSettings,
    TrajectorySettings,
)
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway import app, retention
from robot_bridge.gateway.api.metrics_and_queries import SiteQueries
from robot_bridge.gateway.auth.authorisation import AuthGate
from robot_bridge.gateway.field.page import FieldPage
from robot_bridge.gateway.fleet.link_supervision import LinkProcesses
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.model.events import RequestHandlers
from robot_bridge.gateway.retention import Retention
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.requests import MOST_UNREAD_ACKS, add_answers
from robot_bridge.gateway.storage.repositories.trajectories import Fix, TrajectoryQuery, pack
from robot_bridge.gateway.storage.schema import (
    audit,
    closures,
    command_steps,
    commands,
    emergency_stops,
    metadata,
    observations,
    sa,
    sessions,
)

NOW = 1_790_000_000.25
DAY = 86400.0
WEEK = {"keep_days": 7.0}


@pytest.fixture
async def database(url):
    opened = Database(url)
    await opened.open()
    yield opened
    await opened.close()


@pytest.fixture(scope="module")
def site(sample_site):
    return read_site(sample_site)


@pytest.fixture
def settings(site):
    """A site that keeps everything for a week, and images for two days."""
    return replace(
        site.settings,
        trajectories=TrajectorySettings(**WEEK),
        commands=CommandSettings(**WEEK),
        observations=ObservationSettings(**WEEK, keep_images_days=2.0),
        audit=AuditSettings(**WEEK),
    )


def ago(days):
    return NOW - days * DAY


def command(id, state, days):
    return {
        "id": id,
        "robot": "r1",
        "op": "SetPosEnd",
        "params": "{}",
        "operator": "Ada",
        "state": state,
        "sa_id": 1,
        "created_at": ago(days),
    }


def seen(id, kind, state, told, reviewed=None):
    return {
        "robot": "r1",
        "source": id,
        "object": id,
        "kind": kind,
        "state": state,
        "x": 1.0,
        "y": 1.0,
        "received_at": ago(told),
        "reviewed_at": None if reviewed is None else ago(reviewed),
        "image": b"image" if kind == "SendImage" else None,
    }


def stop(id, days, cleared):
    return {"id": id, "at": ago(days), "by": "Ada", "cleared_at": None if cleared is None else ago(cleared)}


def closure(id, closed, opened):
    return {
        "id": id,
        "line": "[[0, 0], [1, 0]]",
        "level": 0,
        "closed_at": ago(closed),
        "closed_by": "Ada",
        "opened_at": None if opened is None else ago(opened),
    }


def entry(who, days):
    return {"at": ago(days), "who": who, "action": "send", "done": 1}


def session(id, began, ended):
    return {
        "id": id,
        "operator": "Ada",
        "role": "viewer",
        "address": "here",
        "began_at": ago(began),
        "ended_at": None if ended is None else ago(ended),
    }


ROWS = {
    commands: [
        command("old-reached", "reached", 8),
        command("old-failed", "failed", 30),
        command("old-open", "acknowledged", 30),
        command("new-reached", "reached", 6),
    ],
    command_steps: [
        {"command": id, "state": "queued", "at": ago(8), "by": "Ada"}
        for id in ("old-reached", "old-reached", "old-failed", "old-open", "new-reached")
    ],
    closures: [closure("old", 9, 8), closure("closed", 99, None), closure("new", 9, 6)],
    emergency_stops: [stop("old", 9, 8), stop("in-force", 9, None), stop("new", 9, 6)],
    observations: [
        seen("rejected", "SetObject", "rejected", 9, 8),
        seen("rejected lately", "SetObject", "rejected", 9, 1),
        seen("on the map", "SetObject", "accepted", 99, 98),
        seen("waits", "SetObject", "pending", 99),
        seen("old image", "SendImage", "accepted", 4, 3),
        seen("other old image", "SendImage", "rejected", 4, 3),
        seen("new image", "SendImage", "accepted", 1, 1),
        seen("image reviewed lately", "SendImage", "accepted", 4, 1),
        seen("image that waits", "SendImage", "pending", 99),
    ],
    audit: [entry("old", 8), entry("new", 6)],
    sessions: [session("old", 9, 8), session("open", 99, None), session("new", 9, 6)],
}
KEPT = {
    commands.c.id: {"old-open", "new-reached"},
    command_steps.c.command: {"old-open", "new-reached"},
    closures.c.id: {"closed", "new"},
    emergency_stops.c.id: {"in-force", "new"},
    observations.c.object: {
        "rejected lately",
        "on the map",
        "waits",
        "new image",
        "image reviewed lately",
        "image that waits",
    },
    audit.c.who: {"new"},
    sessions.c.id: {"open", "new"},
}


def fill(connection):
    for table, rows in ROWS.items():
        connection.execute(insert(table), rows)


def left(connection):
    return {column: set(connection.scalars(select(column))) for column in KEPT}


async def test_of_opacks_that_a_robot_does_not_read_the_newest_stay_and_its_commands(database, site, caplog):
    """Whatever the clock says."""
    target, stop = SetPosEnd(1.0, 2.0), Abort(emergency=True)
    acks = [("r1", OpAck(id=id)) for id in range(2 * MOST_UNREAD_ACKS)]
    others = [("r2", OpAck(id=id)) for id in range(MOST_UNREAD_ACKS)]
    await database.run(add_answers, [("r1", target), ("r1", stop), *acks, *others])
    pruning = Retention(database, site, ManualClock(wall=NOW))
    pruning.doubt_clock()
    await pruning.prune()
    rows = await database.run(lambda its: list(its.execute(select(sa.c.robot, sa.c.op, sa.c.params))))
    kept = [(robot, op, json.loads(params).get("id")) for robot, op, params in rows]
    newest = range(MOST_UNREAD_ACKS, 2 * MOST_UNREAD_ACKS)
    assert sorted(kept, key=str) == sorted(
        [
            ("r1", "SetPosEnd", None),
            ("r1", "Abort", None),
            *(("r1", "OpAck", id) for id in newest),
            *(("r2", "OpAck", id) for id in range(MOST_UNREAD_ACKS)),
        ],
        key=str,
    )
    assert f"robot r1: it does not read its OpAcks in sa: {MOST_UNREAD_ACKS} were deleted" in caplog.text


async def test_what_is_too_old_goes_and_all_else_stays(database, settings):
    await database.run(fill)
    await Retention(database, SimpleNamespace(settings=settings), ManualClock(wall=NOW)).prune()
    assert await database.run(left) == KEPT


async def test_nothing_goes_before_the_times_that_hold_without_settings(database, site):
    await database.run(fill)
    count = await database.run(rows)
    await Retention(database, site, ManualClock(wall=ago(0) + 50 * DAY)).prune()
    assert await database.run(rows) == count
    await Retention(database, site, ManualClock(wall=ago(0) + 370 * DAY)).prune()
    assert set((await database.run(left))[commands.c.id]) == {"old-open"}


async def test_a_clock_that_was_set_far_ahead_deletes_nothing_for_a_day(database, settings, caplog):
    await database.run(fill)
    clocks, count = ManualClock(wall=NOW), await database.run(rows)
    keeping = Retention(database, SimpleNamespace(settings=settings), clocks)
    clocks.wall += 4000 * DAY
    await keeping.prune()
    clocks.advance(DAY - 60)
    await keeping.prune()
    assert await database.run(rows) == count
    assert "set forward by 4000.0 days; for a day nothing is deleted for its age" in caplog.text
    clocks.advance(120)
    await keeping.prune()
    assert (await database.run(left))[audit.c.who] == set()


async def test_a_clock_that_may_be_ahead_from_the_start_deletes_nothing_for_a_day(database, settings):
    await database.run(fill)
    clocks, count = ManualClock(wall=NOW), await database.run(rows)
    keeping = Retention(database, SimpleNamespace(settings=settings), clocks)
    keeping.doubt_clock()
    clocks.advance(DAY - 60)
    await keeping.prune()
    assert await database.run(rows) == count
    clocks.advance(120)
    await keeping.prune()
    assert await database.run(rows) != count


async def test_a_clock_that_was_set_right_again_deletes_no_more_than_before(database, settings):
    await database.run(fill)
    clocks = ManualClock(wall=NOW)
    keeping = Retention(database, SimpleNamespace(settings=settings), clocks)
    clocks.wall += 4000 * DAY
    await keeping.prune()
    clocks.wall -= 4000 * DAY
    clocks.advance(60)
    await keeping.prune()
    clocks.uptime += DAY
    clocks.wall += DAY / 100
    await keeping.prune()
    assert await database.run(left) == KEPT


def rows(connection):
    return {t.name: connection.scalar(select(func.count()).select_from(t)) for t in metadata.sorted_tables}


async def test_it_goes_in_pieces_between_which_others_have_the_database(database, settings, monkeypatch):
    monkeypatch.setattr(
        retention, "kept", lambda s: [retention.RetainedRows("positions", 7.0, trajectories.forget, 100)]
    )
    fixes = [Fix("r1", at, SendPos(x, 0.0, 0.5, 1.0)) for at, x in times()]
    await database.run(trajectories.add, list(map(pack, fixes)))
    pruning = asyncio.create_task(
        Retention(database, SimpleNamespace(settings=settings), ManualClock(wall=NOW)).prune()
    )
    counts = set()
    while not pruning.done():
        counts.add(len(await database.run(trajectories.read, TrajectoryQuery(), 5000, None)))
        await asyncio.sleep(0.01)
    assert len(counts & {452, 352, 252, 152, 52}) >= 2
    found = await database.run(trajectories.read, TrajectoryQuery(), 5000, None)
    assert [place.x for place in found] == [2.0, 3.0]


def times():
    yield from ((ago(8) + n, 1.0) for n in range(550))
    yield ago(6), 2.0
    yield NOW, 3.0


@pytest.mark.parametrize("kind", ["sqlite"], indirect=True)
async def test_the_gateway_does_it_by_the_settings_of_its_site(
    database, site, settings, tmp_path, monkeypatch
):
    monkeypatch.setattr(app, "PRUNE_INTERVAL", 0.01)
    monkeypatch.setattr(app.time, "time", lambda: NOW)
    await database.run(fill)
    maps = SiteMaps(replace(site, settings=settings))
    fleet = Fleet(maps, database)
    gate, links = (
        AuthGate(database, LimitSettings(), may_be_open=True),
        LinkProcesses(settings.links, tmp_path),
    )
    queries = SiteQueries(maps, RequestHandlers())
    gateway = app.Gateway(fleet, gate, links, RequestHandlers(), FieldPage(maps), queries)
    work = gateway.works("ws://127.0.0.1:1")["prune"]
    pruning = asyncio.create_task(work())
    async with asyncio.timeout(10):
        while "prune" not in fleet.counters.beats:
            await asyncio.sleep(0.01)
    pruning.cancel()
    assert await database.run(left) == KEPT
