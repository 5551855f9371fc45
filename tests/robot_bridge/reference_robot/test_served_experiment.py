"""An experiment at a real gateway: two robots at once, each by its filter, with maps of parts of the site."""

from __future__ import annotations

import sqlite3
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from sqlalchemy import make_url

from robot_bridge.cli.served_experiment import ServedDrives, drive_at_gateway
from robot_bridge.core.errors import BridgeError
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import read_site, write_site
from robot_bridge.reference_robot.localisation.experiment import Carried, ExperimentSettings, route_from
from robot_bridge.reference_robot.localisation.experiment_report import figures, table_text
from robot_bridge.reference_robot.localisation.settings import (
    FilterSettings,
    LaserSettings,
    OdometrySettings,
    WorldSettings,
)

SETTINGS = ExperimentSettings(
    route=[(156.0, 43.0), (162.0, 43.0), (162.0, 46.0), (156.0, 46.0), (156.0, 43.0)],
    laser=LaserSettings(beams=40),
    filter=FilterSettings(least=150, most=1500),
    end_heading_deg=0.0,
)


@pytest.fixture
def drives(sample_site, tmp_path):
    database = make_url(f"sqlite:///{tmp_path}/loop.db")
    return ServedDrives(sample_site, database, "loop", at_once=True, pace=100.0, window=60.0)


def test_robots_drive_round_at_a_gateway_and_are_stored_there(drives, sample_site, tmp_path):
    records = drive_at_gateway(drives, read_site(sample_site).whole_map(), SETTINGS, [1, 2])
    assert [record.seed for record in records] == [1, 2]
    for record in records:
        assert record.driven[-1] > 12 and not record.lost.any()
        assert record.maps >= 1 and record.map_bytes > 500 and record.clearance > 0
    row = figures(records)[-1]
    assert row.max_m < 0.5
    assert "bytes of maps" in table_text([row]) and "nearest to anything" in table_text([row])
    with sqlite3.connect(tmp_path / "loop.db") as stored:
        robots = {name for (name,) in stored.execute("select distinct robot from trajectories")}
    assert robots == {"loop-1", "loop-2"}


def pillar(x, y):
    around = np.linspace(0, 2 * np.pi, 25)
    ring = np.column_stack([x + 0.3 * np.cos(around), y + 0.3 * np.sin(around)])
    return OutlineRow(ring, ShapeType.CLOSED_POLYGON, 2.0, "pillar", f"pillars:{x:.0f}")


def test_what_a_robot_reports_and_an_operator_accepts_brings_down_the_error_of_others(tmp_path):
    frame = SiteSettings(
        id="corridor", name="Corridor", version=1, crs="EPSG:32633", origin=(640420.0, 5193480.0),
        bounds=SiteBounds(0.0, 0.0, 45.0, 8.0), rotation_deg=0.0,
    )  # fmt: skip
    # How far along its plain walls it is a robot cannot see.
    walls = np.array([[0, 0], [45, 0], [45, 8], [0, 8], [0, 0]], dtype=float)
    rows = [OutlineRow(walls, ShapeType.OPEN_POLYGON, 3.0, "wall", "walls:1")]
    write_site(tmp_path / "map", frame, Outlines.from_rows(rows), [], [], [])
    rows += [pillar(17.0, 2.2), pillar(23.0, 5.8), pillar(29.0, 2.2)]
    world = build_map(Outlines.from_rows(rows), Window.from_bounds(0, 0, 45, 8), {"id": "corridor"})
    surveyor = ExperimentSettings(
        route=[(5.0, 4.0), (38.0, 4.0)],
        laser=LaserSettings(reach=10.0, short=0.1),
        odometry=OdometrySettings(scale=0.0),
        filter=FilterSettings(least=300, most=2000),
    )
    # One that knows less well how far it has come.
    settings = msgspec.structs.replace(surveyor, odometry=OdometrySettings(scale=0.04))
    database = make_url(f"sqlite:///{tmp_path}/corridor.db")
    drives = ServedDrives(tmp_path / "map", database, "corridor", pace=100.0, accept=True, reporter=surveyor)
    before, after = drive_at_gateway(drives, world, settings, [11])
    assert (before.accepted, after.accepted) == (None, 3)
    assert after.map_bytes > before.map_bytes
    assert figures([after])[0].mean_m < 0.7 * figures([before])[0].mean_m
    with sqlite3.connect(tmp_path / "corridor.db") as stored:
        found = stored.execute(
            "select robot, state, count(*) from observations where kind = 'SetObject' group by robot, state"
        )
        # What is on the map is reported no more; in the end the map is as it was.
        assert sorted(found) == [("corridor-11", "pending", 3), ("corridor-reporter-11", "rejected", 3)]


def test_a_robot_that_is_carried_away_is_none_for_a_gateway(drives):
    settings = msgspec.structs.replace(SETTINGS, carried=Carried(1.0, 1.0))
    with pytest.raises(BridgeError, match="stands until it is told; leave --gateway out"):
        drive_at_gateway(drives, None, settings, [1])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"accept": True}, "give --accept or --at-once, not both"),
        (
            {"reporter": ExperimentSettings(world=WorldSettings(moved=0.1))},
            r"the reporter is set to another world; give both the same \[world\]",
        ),
    ],
)
def test_reviews_are_of_one_robot_in_one_world(drives, changes, said):
    with pytest.raises(BridgeError, match=said):
        drive_at_gateway(replace(drives, **changes), None, SETTINGS, [1])


def test_a_route_begins_after_a_part_of_it_and_ends_there():
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)]
    assert route_from(square, 0.0) == square
    begun = [(4.0, 2.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0), (4.0, 0.0), (4.0, 2.0)]
    assert route_from(square, 0.375) == begun
