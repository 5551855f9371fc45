"""Days of trajectories as GeoParquet, read by DuckDB with its spatial functions."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import pytest

from robot_bridge.core.clock import SYSTEM_CLOCK
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import DAY, Fix, pack
from robot_bridge.gateway.trajectories import archive
from tests.support.bridge.command_line import run_command
from tests.support.databases.archive_reader import duckdb_with_spatial
from tests.support.fleet import SITE, serve
from tests.support.processes import Processes

TODAY = int(SYSTEM_CLOCK.time() // DAY)
THEN = TODAY - 3
"""A day of which positions are stored at both of its ends; of the next one a single one is, of today one."""
LAST_MOMENT = math.nextafter((THEN + 1) * DAY, 0)
STORED = [
    Fix("r1", THEN * DAY - 0.5, SendPos(0.0, 0.0, 0.0, 0.0)),
    Fix("r1", THEN * DAY, SendPos(1.0, 2.0, 0.5, 1.0, 5.0, fix_t=4.0)),
    *(Fix("r2", THEN * DAY + 10 + n, SendPos(3.0 + n, 7.0, 0.0, 0.5)) for n in range(5)),
    Fix("r1", THEN * DAY + 12.000001, SendPos(2.0, 2.0, 0.5, 1.0, 17.0)),
    Fix("r1", LAST_MOMENT, SendPos(9.0, 9.0, 0.0, 0.0)),
    Fix("r1", (THEN + 1) * DAY, SendPos(9.0, 9.5, 0.0, 0.0)),
    Fix("r1", TODAY * DAY, SendPos(9.0, 9.5, 0.0, 0.0)),
]


def named(folder: Path, day: int) -> Path:
    return folder / f"trajectories-{archive.day_name(day)}.parquet"


@pytest.fixture(scope="module")
def spatial():
    return duckdb_with_spatial()


@pytest.fixture
def turned_site(sample_site, tmp_path):
    """The folder of a site whose x axis points north."""
    folder = tmp_path / "site"
    folder.mkdir()
    text = (sample_site / "site.toml").read_text(encoding="utf-8")
    turned = text.replace("rotation_deg = 0.0", "rotation_deg = 90.0")
    (folder / "site.toml").write_text(turned, encoding="utf-8")
    return folder


@pytest.fixture
def url(tmp_path, new_database):
    url = new_database.at(tmp_path / "fleet.db")
    run_once(url, trajectories.add, list(map(pack, STORED)))
    return url


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "archive"
    folder.mkdir()
    return folder


@pytest.fixture
def run(url, turned_site, folder, monkeypatch):
    monkeypatch.setattr(archive, "PAGE", 3)

    def run(*options):
        where = ["--site", turned_site, "--database", url]
        return run_command("trajectories", "archive", folder, *where, *options)

    return run


def test_a_file_holds_a_whole_day_and_no_more(run, folder, spatial):
    done = run()
    assert done.returncode == 0, done.stderr
    assert f"{named(folder, THEN)}: 8 positions of 2 robots\n" in done.stdout
    # Today is not over, and the days between have no position.
    days = [THEN - 1, THEN, THEN + 1]
    assert sorted(folder.iterdir()) == [named(folder, day) for day in days]
    rows = spatial.execute(
        "select robot, epoch_us(time), x, y, theta, v, device_time, fix_time, heading, "
        "ST_X(geometry), ST_Y(geometry) from read_parquet($1)",
        [str(named(folder, THEN))],
    ).fetchall()
    of_day = sorted(
        (fix for fix in STORED if fix.received_at // DAY == THEN), key=lambda fix: fix.received_at
    )
    expected = [
        (robot, round(at * 1e6), pose.x, pose.y, pose.theta, pose.v, pose.t, pose.fix_t)
        for robot, at, pose in of_day
    ]
    assert [row[:8] for row in rows] == expected
    for _, _, x, y, theta, *_, heading, easting, northing in rows:
        # The site's x axis points north, theta goes to the left.
        assert heading == pytest.approx(-math.degrees(theta) % 360.0)
        assert (easting, northing) == pytest.approx((640420.0 - y, 5193480.0 + x), abs=1e-6)


def test_what_the_file_says_of_itself_is_geoparquet(run, folder, spatial):
    run()
    file = str(named(folder, THEN))
    (found,) = spatial.execute("select distinct typeof(geometry) from read_parquet($1)", [file]).fetchone()
    assert found == "GEOMETRY('EPSG:32633')"
    pairs = spatial.execute("select key, value from parquet_kv_metadata($1)", [file]).fetchall()
    said = {bytes(key).decode(): bytes(value).decode() for key, value in pairs}
    geo, frame = json.loads(said["geo"]), json.loads(said["site_frame"])
    column = geo["columns"][geo["primary_column"]]
    assert (geo["version"], column["encoding"], column["geometry_types"]) == ("1.1.0", "WKB", ["Point"])
    assert column["crs"]["id"] == {"authority": "EPSG", "code": 32633}
    assert column["bbox"] == pytest.approx([640411.0, 5193481.0, 640418.0, 5193489.0])
    assert column["covering"]["bbox"]["ymax"] == ["bbox", "ymax"]
    assert frame == {"crs": "EPSG:32633", "origin": [640420.0, 5193480.0], "rotation_deg": 90.0}
    # A row group is a page, and its statistics say when it is; boxes hold their points, and are tight.
    groups = """select count(distinct row_group_id) from parquet_metadata($1)
        where path_in_schema = 'time' and stats_min_value is not null"""
    assert spatial.execute(groups, [file]).fetchone() == (3,)
    outside = """select count(*) from read_parquet($1) where not (
        ST_X(geometry) between bbox.xmin and bbox.xmax and ST_Y(geometry) between bbox.ymin and bbox.ymax
        and bbox.ymax - bbox.ymin <= 1.0)"""
    assert spatial.execute(outside, [file]).fetchone() == (0,)


def test_a_day_that_is_there_is_left_alone_unless_asked(run, folder):
    file = named(folder, THEN)
    file.write_text("mine")
    done = run("--since", archive.day_name(THEN), "--until", archive.day_name(THEN))
    assert (done.returncode, file.read_text()) == (0, "mine")
    assert f"1 day in {folder} already; --replace writes them anew" in done.stdout
    assert list(folder.iterdir()) == [file]
    run("--since", archive.day_name(THEN), "--replace")
    assert file.read_bytes()[:4] == b"PAR1"


def test_days_of_which_some_may_be_deleted_are_written_only_when_named(run, turned_site, folder):
    settings = turned_site / "site.toml"
    settings.write_text(settings.read_text() + "\n[trajectories]\nkeep_days = 3\n")
    assert run().returncode == 0
    assert list(folder.iterdir()) == [named(folder, THEN + 1)]
    run("--since", archive.day_name(THEN))
    assert named(folder, THEN).exists()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--until", archive.day_name(TODAY + 1)], "is not over yet"),
        (["--since", archive.day_name(TODAY)], "no day is from"),
        (["--since", "yesterday"], "--since 'yesterday' is no day; write it like 2026-11-21"),
    ],
)
def test_what_cannot_be_is_named(run, folder, options, says):
    done = run(*options)
    assert (done.returncode, "Traceback" in done.stderr) == (1, False)
    assert says in done.stderr and list(folder.iterdir()) == []


def test_a_folder_that_is_not_there_is_named(run, folder):
    folder.rmdir()
    done = run()
    assert done.returncode == 1 and "cannot be written: No such file or directory" in done.stderr


def test_without_pyarrow_it_says_how_to_install_it(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    done = run()
    assert done.returncode == 1 and "fleet-supervisor-robot-bridge[archive]" in done.stderr


def test_a_day_that_is_deleted_on_the_way_is_not_written(run, url, folder, monkeypatch):
    add = archive.DayFile.add

    def add_and_delete(self, places):
        add(self, places)
        run_once(url, trajectories.forget, (THEN + 1) * DAY, 100)

    monkeypatch.setattr(archive.DayFile, "add", add_and_delete)
    done = run("--since", archive.day_name(THEN))
    assert done.returncode == 1
    assert "were deleted or added while they were archived; that day is not written" in done.stderr
    assert list(folder.iterdir()) == []


def test_on_postgresql_days_are_those_of_all_partitions(new_database, turned_site, folder):
    """The oldest is taken, however old: there days are dropped whole."""
    url = new_database("postgresql")
    run_once(
        url, trajectories.add, [pack(fix._replace(received_at=fix.received_at - 100 * DAY)) for fix in STORED]
    )
    run_once(url, trajectories.make_days, [THEN - 100])
    done = run_command("trajectories", "archive", folder, "--site", turned_site, "--database", url)
    assert done.returncode == 0, done.stderr
    days = [THEN - 101, THEN - 100, THEN - 99, TODAY - 100]
    assert sorted(folder.iterdir()) == [named(folder, day) for day in days]
    assert f"{named(folder, THEN - 100)}: 8 positions of 2 robots\n" in done.stdout


def test_a_gateway_does_not_load_what_archives_are_written_with(tmp_path):
    with Processes(tmp_path / "logs") as processes:
        served = serve(processes, SITE, f"sqlite:///{tmp_path}/fleet.db")
        loaded = Path(f"/proc/{served.process.pid}/maps").read_text()
    assert "_geometry" in loaded or "pyogrio" in loaded
    assert "arrow" not in loaded
