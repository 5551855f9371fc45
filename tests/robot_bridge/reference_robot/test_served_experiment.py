"""An experiment at a real gateway: two robots at once, each by its filter, with maps of parts of the site."""

from __future__ import annotations

import sqlite3

import msgspec
import pytest
from sqlalchemy import make_url

from robot_bridge.commands.served_experiment import ServedDrives, drive_at_gateway
from robot_bridge.errors import BridgeError
from robot_bridge.reference_robot.experiment import Carried, ExperimentSettings, route_from
from robot_bridge.reference_robot.experiment_report import figures, table_text
from robot_bridge.reference_robot.settings import FilterSettings, LaserSettings
from robot_bridge.sites.publication import read_site

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


def test_a_robot_that_is_carried_away_is_none_for_a_gateway(drives):
    settings = msgspec.structs.replace(SETTINGS, carried=Carried(1.0, 1.0))
    with pytest.raises(BridgeError, match="stands until it is told; leave --gateway out"):
        drive_at_gateway(drives, None, settings, [1])


def test_a_route_begins_after_a_part_of_it_and_ends_there():
    square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)]
    assert route_from(square, 0.0) == square
    begun = [(4.0, 2.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0), (4.0, 0.0), (4.0, 2.0)]
    assert route_from(square, 0.375) == begun
