"""Trajectories as a GeoPackage, read with GDAL: CRS of the site, its rotation, UTC times, lines with M."""

import asyncio
import math
import re

import pytest
from osgeo import ogr

from robot_bridge.cli.options import database_address
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.model.robots import Robot
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import robots as stored_robots
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import Fix, PageMark, TrajectoryQuery, pack
from robot_bridge.gateway.trajectories import exchange
from tests.support.bridge.command_line import run_command

ogr.UseExceptions()
BEGIN = 1_790_000_000.125
"""2026-09-21T14:13:20.125Z"""


def run(*options):
    return run_command(*options)


@pytest.fixture
def turned_site(sample_site, tmp_path):
    """The folder of a site whose x axis points north."""
    folder = tmp_path / "site"
    folder.mkdir()
    text = (sample_site / "site.toml").read_text(encoding="utf-8")
    (folder / "site.toml").write_text(
        text.replace("rotation_deg = 0.0", "rotation_deg = 90.0"), encoding="utf-8"
    )
    return folder


@pytest.fixture
async def database(tmp_path, new_database):
    opened = Database(database_address(new_database.at(tmp_path / "fleet.db"), None))
    await opened.open()
    yield opened
    await opened.close()


@pytest.fixture
async def driven(database):
    """Two robots drive along x for five seconds each; r1 is silent for two minutes and drives on."""
    fixes = [
        Fix(robot, at + gap + offset, SendPos(at - BEGIN + gap, 10.0 * offset, 0.5, 1.0, 5.0, fix_t=4.0))
        for robot, offset in (("r1", 0.0), ("r2", 0.5))
        for gap in (0.0, 120.0)
        for at in (BEGIN + n for n in range(5))
        if robot == "r1" or not gap
    ]
    in_order = sorted(fixes, key=lambda one: one.received_at)
    await database.run(trajectories.add, list(map(pack, in_order)))
    return database


@pytest.fixture
def export(driven, turned_site, tmp_path):
    file = tmp_path / "out.gpkg"

    def export(*options):
        where = ["--site", turned_site, "--database", f"sqlite:///{tmp_path}/fleet.db"]
        done = run("trajectories", "export", file, *where, *options)
        assert done.returncode == 0, done.stderr
        return done.stdout, ogr.Open(str(file))

    return export


def rows(dataset, layer):
    found = dataset.GetLayerByName(layer)
    found.ResetReading()
    return [(feature.items(), feature.geometry().Clone()) for feature in found]


def test_positions_lie_in_the_sites_crs_turned_as_the_site_is(export):
    said, dataset = export()
    assert said.strip().endswith("out.gpkg: 15 positions, 3 tracks")
    positions = rows(dataset, "positions")
    assert len(positions) == 15
    assert dataset.GetLayerByName("positions").GetSpatialRef().GetAuthorityCode(None) == "32633"
    fields, point = positions[2]  # r1 and r2 take turns
    assert fields["robot"] == "r1" and (fields["x"], fields["y"]) == (1.0, 0.0)
    # The site's x axis points north, so 1 m along it is 1 m north of the origin.
    assert (point.GetX(), point.GetY()) == pytest.approx((640420.0, 5193481.0), abs=1e-6)
    assert fields["time"] == "2026/09/21 14:13:21.125+00"
    assert (fields["device_time"], fields["fix_time"], fields["v"]) == (5.0, 4.0, 1.0)
    # theta 0.5 from the x axis, which points north, to the left.
    assert fields["heading"] == pytest.approx(360.0 - math.degrees(0.5))


def test_tracks_are_lines_with_the_time_as_their_measure(export):
    _, dataset = export()
    tracks = sorted(rows(dataset, "tracks"), key=lambda row: (row[0]["robot"], row[0]["begin"]))
    assert [(f["robot"], f["count"], f["length_m"]) for f, _ in tracks] == [
        ("r1", 5, 4.0),
        ("r1", 5, 4.0),
        ("r2", 5, 4.0),
    ]
    fields, line = tracks[0]
    assert (fields["begin"], fields["end"]) == ("2026/09/21 14:13:20.125+00", "2026/09/21 14:13:24.125+00")
    assert line.IsMeasured() and [line.GetM(n) for n in range(5)] == [BEGIN + n for n in range(5)]
    assert [line.GetY(n) - 5193480.0 for n in range(5)] == pytest.approx([0, 1, 2, 3, 4])


def test_a_longer_gap_keeps_a_track_whole(export):
    _, dataset = export("--gap", 300, "--robot", "r1")
    ((fields, _),) = rows(dataset, "tracks")
    assert (fields["count"], fields["length_m"]) == (10, 124.0)


@pytest.mark.parametrize(
    ("options", "count"),
    [
        (["--robot", "r2"], 5),
        (["--robot", "r1", "--robot", "r2"], 15),
        (["--since", "2026-09-21T14:15:00"], 5),
        (["--since", "2026-09-21T16:15:00+02:00"], 5),
        (["--until", "2026-09-21T14:13:20.5"], 1),
        (["--bounds", "1.5,-1,3.5,1"], 2),
        (["--robot", "r2", "--since", "2026-09-22T00:00"], 0),
    ],
)
def test_it_may_be_some_robots_a_time_and_an_area(export, options, count):
    said, dataset = export(*options)
    assert f"{count} position{'s' * (count != 1)}, " in said
    assert len(rows(dataset, "positions")) == count
    assert dataset.GetLayerByName("tracks") is not None


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["out.txt"], "out.txt is no name for a GeoPackage"),
        (
            ["out.gpkg", "--since", "yesterday"],
            "--since 'yesterday' is no time; write it like 2026-11-21T08:00",
        ),
        (["out.gpkg", "--bounds", "1,2,3"], "--bounds '1,2,3' cannot be read"),
        (["out.gpkg", "--bounds", "3,0,1,1"], "--bounds '3,0,1,1' holds nothing"),
        (["out.gpkg", "--robot", "r 1"], "robot name 'r 1' cannot be used"),
    ],
)
def test_what_is_wrong_is_named(turned_site, tmp_path, monkeypatch, options, says):
    monkeypatch.chdir(tmp_path)
    done = run("trajectories", "export", *options, "--site", turned_site)
    assert (done.returncode, "Traceback" in done.stderr) == (1, False)
    assert says in done.stderr
    assert not re.search(r"out|\.writing", " ".join(file.name for file in tmp_path.iterdir()))


@pytest.mark.parametrize("more", [[], ["--robot", "r1"]])
async def test_a_robot_that_is_not_known_is_named_and_nothing_is_written(driven, turned_site, tmp_path, more):
    await driven.run(
        stored_robots.save, [stored_robots.row(Robot(name, 1, "sql", 0.0)) for name in ("r1", "r2")]
    )
    where = ["--site", turned_site, "--database", f"sqlite:///{tmp_path}/fleet.db"]
    words = "trajectories", "export", tmp_path / "out.gpkg", *where, *more, "--robot", "r11"
    # The command has an event loop of its own.
    done = await asyncio.to_thread(run, *words)
    assert done.returncode == 1
    assert "no position of robot 'r11' is stored in this database" in done.stderr
    assert "known in it: r1, r2." in done.stderr
    assert not (tmp_path / "out.gpkg").exists()


def test_a_file_that_is_there_is_replaced_only_when_told(export, tmp_path, turned_site):
    file = tmp_path / "out.gpkg"
    file.write_text("mine")
    done = run(
        "trajectories", "export", file, "--site", turned_site, "--database", f"sqlite:///{tmp_path}/fleet.db"
    )
    assert "is there already; choose another name, or give --replace" in done.stderr
    assert file.read_text() == "mine"
    assert len(rows(export("--replace")[1], "positions")) == 15


# --- pages --------------------------------------------------------------------------------------------------


async def test_pages_hold_every_position_once(driven, monkeypatch, tmp_path):
    whole = await driven.run(trajectories.read, TrajectoryQuery(), 100, None)
    found, after = [], None
    while page := await driven.run(trajectories.read, TrajectoryQuery(), 4, after):
        found += page
        after = PageMark(page[-1].received_at, page[-1].id)
    assert found == whole and len(whole) == 15


async def test_an_export_in_many_pages_is_the_same(driven, turned_site, tmp_path, monkeypatch):
    from robot_bridge.core.sites.settings import read_settings

    frame = read_settings(turned_site / "site.toml").frame
    monkeypatch.setattr(exchange, "PAGE", 4)
    written = await exchange.export_trajectories(
        driven, TrajectoryQuery(), frame, tmp_path / "pages.gpkg", 60.0
    )
    assert (written.positions, written.tracks) == (15, 3)
    dataset = ogr.Open(str(tmp_path / "pages.gpkg"))
    assert [len(rows(dataset, layer)) for layer in ("positions", "tracks")] == [15, 3]
