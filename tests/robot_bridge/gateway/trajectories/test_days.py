"""Days of positions on a real PostgreSQL: each a partition, made ahead, dropped whole, and never missed."""

from __future__ import annotations

import asyncio
import time
from contextlib import closing
from dataclasses import replace
from types import SimpleNamespace

import pytest
from alembic import command
from sqlalchemy import Engine, insert, make_url, text
from sqlalchemy.exc import DBAPIError

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.sites.settings_tables import LimitSettings, TrajectorySettings
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway import app
from robot_bridge.gateway.api.metrics_and_queries import SiteQueries
from robot_bridge.gateway.auth.authorisation import AuthGate
from robot_bridge.gateway.field.page import FieldPage
from robot_bridge.gateway.fleet.link_supervision import LinkProcesses
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.model.events import RequestHandlers
from robot_bridge.gateway.retention import DAYS_AHEAD, Retention
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.backup import back_up
from robot_bridge.gateway.storage.database import Database, open_engine, run_once
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import DAY, Fix, TrajectoryQuery, pack
from robot_bridge.gateway.storage.schema import trajectories as table
from robot_bridge.gateway.trajectories.exchange import RecordedDrive, import_drives
from tests.support.databases.database_server import add_accounts

THEN = 30_000
"""The number of a day in 2052, of which nobody has made a partition: 2052-02-20."""
WITHIN = 60.0
"""seconds for what takes some tenths of one, and for ever without a limit on its waiting."""


def day_name(day: int) -> str:
    return time.strftime("trajectories_%Y%m%d", time.gmtime(day * DAY))


def fixes(*days: float):
    return [pack(Fix("r1", day * DAY, SendPos(day, 0.0, 0.5, 1.0))) for day in days]


def stored(connection) -> list[tuple]:
    return [tuple(row) for row in connection.execute(table.select().order_by(table.c.id))]


def counts(connection) -> dict[str, int]:
    """How many positions are in each partition that has some."""
    query = "select tableoid::regclass::text, count(*) from trajectories group by 1"
    return dict(connection.execute(text(query)).all())


def partitions(connection) -> set[str]:
    return set(connection.scalars(text("select name::text from public.trajectory_partitions()")))


@pytest.fixture
def url(new_database) -> str:
    return new_database("postgresql")


@pytest.fixture
async def database(url):
    opened = Database(url, patience=None)
    yield opened
    await opened.close()


@pytest.fixture
def reader(database):
    """Somebody who has begun to read the table, and goes on until ``reader.rollback()``."""
    engine: Engine = open_engine(database.url, None)[0]
    with closing(engine.connect()) as connection:
        connection.execute(text("select 1 from trajectories")).all()
        yield connection


@pytest.fixture
def site(sample_site):
    return read_site(sample_site)


@pytest.fixture
def keeping_a_week(site):
    """Make the retention of a site that keeps positions for a week: ``keeping_a_week(database, day)``."""
    settings = replace(site.settings, trajectories=TrajectorySettings(keep_days=7.0))
    return lambda database, day: Retention(
        database, SimpleNamespace(settings=settings), ManualClock(wall=day * DAY)
    )


def test_what_was_stored_stays_in_an_upgrade_and_in_a_downgrade(postgresql_url):
    today = time.time() // DAY
    begun, after, far = today - 8, today + 1.5, today + 50
    run_once(postgresql_url, revisions.create, "0010")
    row = {"robot": "r1", "x": 1.0, "y": 0.0, "theta": 0.5, "v": 1.0}
    given = [{**row, "received_at": day * DAY} for day in (begun, today, after, far)]
    run_once(postgresql_url, lambda c: c.execute(insert(table), given))
    run_once(postgresql_url, lambda c: c.execute(text("grant select on trajectories to public")))
    before = run_once(postgresql_url, stored)
    assert [row[0] for row in before] == [1, 2, 3, 4]

    assert run_once(postgresql_url, revisions.upgrade) == "0010"
    assert run_once(postgresql_url, stored) == before
    assert run_once(postgresql_url, revisions.differences) == []
    assert run_once(postgresql_url, counts) == {
        "trajectories_before": 2,
        day_name(today + 1): 1,
        "trajectories_other": 1,
    }
    run_once(postgresql_url, trajectories.add, fixes(today, today + 1))
    assert run_once(postgresql_url, counts)[day_name(today + 1)] == 2
    right = text("select has_table_privilege('public', 'trajectories', 'select')")
    assert run_once(postgresql_url, lambda c: c.scalar(right))

    after = run_once(postgresql_url, stored)
    assert [row[0] for row in after] == [1, 2, 3, 4, 5, 6]
    run_once(postgresql_url, lambda c: command.downgrade(revisions._config(c), "0010"))
    assert run_once(postgresql_url, stored) == after
    assert run_once(postgresql_url, revisions.current) == "0010"
    assert run_once(postgresql_url, lambda c: c.scalar(right))
    run_once(postgresql_url, lambda c: c.execute(insert(table), given[:1]))
    assert run_once(postgresql_url, stored)[-1][0] == 7
    run_once(postgresql_url, revisions.upgrade)
    assert run_once(postgresql_url, revisions.differences) == []


async def test_positions_of_a_day_without_a_partition_are_stored_and_go_over_to_it(database):
    await database.run(trajectories.add, fixes(THEN, THEN + 0.5, THEN + 1))
    assert await database.run(counts) == {"trajectories_other": 3}
    assert await database.run(trajectories.make_days, [THEN, THEN + 1], 1) == 1
    assert await database.run(counts) == {"trajectories_other": 2, day_name(THEN + 1): 1}
    assert await database.run(trajectories.make_days, [THEN, THEN + 1], 2) == 0
    await database.run(trajectories.add, fixes(THEN + 0.75))
    assert await database.run(counts) == {day_name(THEN): 3, day_name(THEN + 1): 1}
    places = await database.run(trajectories.read, TrajectoryQuery(), 100)
    assert [place.x - THEN for place in places] == [0, 0.5, 0.75, 1]


async def test_a_day_goes_when_all_of_it_is_too_old(database, keeping_a_week):
    await database.run(trajectories.make_days, [THEN, THEN + 1])
    await database.run(trajectories.add, fixes(THEN - 1, THEN, THEN + 0.9, THEN + 1, THEN + 1.9, THEN + 2))
    await keeping_a_week(database, THEN + 8.5).prune()
    assert await database.run(counts) == {day_name(THEN + 1): 2, "trajectories_other": 1}
    await keeping_a_week(database, THEN + 9).prune()
    assert await database.run(counts) == {"trajectories_other": 1}
    assert day_name(THEN + 1) not in await database.run(partitions)


async def test_what_somebody_has_made_of_a_day_keeps_that_day_and_no_other(database, keeping_a_week):
    await database.run(trajectories.make_days, [THEN, THEN + 1])
    await database.run(trajectories.add, fixes(THEN, THEN + 1, THEN + 2))
    await database.run(lambda c: c.execute(text(f"create view mine as table {day_name(THEN)}")))
    await keeping_a_week(database, THEN + 9).prune()
    assert await database.run(counts) == {day_name(THEN): 1, "trajectories_other": 1}


async def test_who_reads_at_length_holds_nobody_up_and_what_waits_for_him_is_done_later(
    database, reader, keeping_a_week, caplog
):
    late = keeping_a_week(database, THEN + 8)
    await database.run(trajectories.add, fixes(THEN + 8))
    reader.rollback()
    await database.run(trajectories.make_days, [THEN])
    await database.run(trajectories.add, fixes(THEN))
    reader.execute(text("select 1 from trajectories")).all()
    async with asyncio.timeout(WITHIN):
        await late.prune()
        await late.make_days()
        await database.run(trajectories.add, fixes(THEN + 8.1))
    assert await database.run(counts) == {day_name(THEN): 1, "trajectories_other": 2}
    assert "days of positions have no partition yet" in caplog.text
    reader.rollback()
    await late.prune()
    await late.make_days()
    assert await database.run(counts) == {day_name(THEN + 8): 2}


async def test_the_gateways_account_makes_and_drops_days_and_backs_them_up(
    database, url, postgresql_server, keeping_a_week, tmp_path
):
    name = f"days-{make_url(url).database}"
    admin = postgresql_server.admin_url(url)
    accounts = await asyncio.to_thread(add_accounts, url, admin, [f"{name}-bot"], name)
    gateway = Database(accounts[name])
    try:
        assert await gateway.run(trajectories.make_days, [THEN, THEN + 1]) == 0
        await gateway.run(trajectories.add, fixes(THEN - 1, THEN, THEN + 1))
        await asyncio.to_thread(back_up, gateway.url, tmp_path / "backup")
        await keeping_a_week(gateway, THEN + 8).prune()
        assert await gateway.run(counts) == {day_name(THEN + 1): 1}
    finally:
        await gateway.close()
    for call in ("drop_trajectory_day(1)", "delete_old_positions(1, 1)", "make_trajectory_days('{1}', 1)"):
        with pytest.raises(Exception, match="permission denied") as caught:
            await asyncio.to_thread(
                run_once,
                accounts[f"{name}-bot"],
                lambda c, call=call: c.execute(text(f"select public.{call}")),
            )
        assert isinstance(caught.value.__cause__, DBAPIError)


async def test_a_recorded_drive_is_stored_by_its_days(database):
    at = [(THEN + n / 4) * DAY for n in range(6)]
    drive = RecordedDrive("r1", at[0], at[-1], [Fix("r1", t, SendPos(1.0, 0.0, 0.5, 1.0)) for t in at])
    assert await import_drives(database, [drive], TrajectorySettings(), now=(THEN + 2) * DAY) == 6
    assert await database.run(counts) == {day_name(THEN): 4, day_name(THEN + 1): 2}


async def test_the_gateway_makes_the_next_days_in_time(database, site, tmp_path, monkeypatch):
    monkeypatch.setattr(app, "PRUNE_INTERVAL", 0.01)
    maps = SiteMaps(site)
    fleet = Fleet(maps, database)
    gate = AuthGate(database, LimitSettings(), may_be_open=True)
    links = LinkProcesses(site.settings.links, tmp_path)
    queries = SiteQueries(maps, RequestHandlers())
    gateway = app.Gateway(fleet, gate, links, RequestHandlers(), FieldPage(maps), queries)
    gateway.retention._clock = clock = ManualClock(wall=(THEN + 0.999) * DAY)
    working = asyncio.create_task(gateway.works("ws://127.0.0.1:1")["days of positions"]())
    wanted = {day_name(THEN + n) for n in range(DAYS_AHEAD)}
    async with asyncio.timeout(WITHIN):
        while not wanted <= await database.run(partitions):
            await asyncio.sleep(0.01)
        clock.advance(0.002 * DAY)
        while day_name(THEN + DAYS_AHEAD) not in await database.run(partitions):
            await asyncio.sleep(0.01)
    working.cancel()


def test_a_gateway_that_starts_makes_today_at_once(url, sample_site, start_bridge):
    today = int(time.time() // DAY)
    days = {day_name(today + n) for n in range(DAYS_AHEAD)}
    run_once(url, lambda c: [c.execute(text(f"drop table {day}")) for day in sorted(days)])
    bridge = start_bridge(sample_site, url)
    assert run_once(url, partitions) >= days
    bridge.end()
