"""Recorded drives into a database: seen by the gateway that runs on it, whole or not at all."""

import asyncio
import time
from datetime import UTC, datetime

import pytest

from robot_bridge.cli.options import database_address
from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.sites.settings_tables import TrajectorySettings
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import trajectories
from robot_bridge.gateway.storage.repositories.trajectories import Fix, TrajectoryQuery
from robot_bridge.gateway.trajectories.exchange import RecordedDrive, import_drives
from tests.support.bridge.command_line import run_command

AN_HOUR_AGO = time.time() // 1 - 3600.0
BEGIN = datetime.fromtimestamp(AN_HOUR_AGO, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
TABLE = "t_s,car,e,n\n" + "".join(
    f"{10 + n / 2},{car},{640430 + n + offset},5193490\n"
    for n in range(20)
    for car, offset in (("red", 0), ("blue", 50))
)
COLUMNS = [f"--column={pair}" for pair in ("time=t_s", "robot=car", "x=e", "y=n")]
UTM = ["--crs", "EPSG:32633", *COLUMNS]


@pytest.fixture
def database(new_database):
    return new_database("sqlite")


@pytest.fixture
def put(database, sample_site, tmp_path):
    """Import the table: ``put(*options)``."""
    file = tmp_path / "drive.csv"
    file.write_text(TABLE, encoding="utf-8")

    def put(*options, file=file, database=database):
        return run_command(
            "trajectories", "import", file, "--site", sample_site, "--database", database, *options
        )

    return put


def stored(database, *robots):
    async def work():
        opened = Database(database_address(database, None))
        await opened.open()
        try:
            return await opened.run(trajectories.read, TrajectoryQuery(robots), 1000)
        finally:
            await opened.close()

    return asyncio.run(work())


def test_a_drive_is_in_the_replay_of_a_gateway_that_runs_on_the_database(start_bridge, sample_site, put):
    bridge = start_bridge(sample_site)
    done = put(*UTM, "--begin", BEGIN, "--robot", "red=tractor-1", database=bridge.database)
    assert done.returncode == 0, done.stderr
    assert "tractor-1: " in done.stdout and "20 positions stored of 40" in done.stdout
    page = bridge.desk().ask("get_trajectory", {"robots": ["tractor-1"]})
    places = page["places"]
    assert [place[2] for place in places] == pytest.approx([10.0 + n for n in range(20)], abs=1e-6)
    assert [place[1] for place in places] == pytest.approx([AN_HOUR_AGO + n / 2 for n in range(20)])
    # The speed is from the movement: 1 m in half a second.
    assert places[5][5] == pytest.approx(2.0)
    again = put(*UTM, "--begin", BEGIN, "--robot", "red=tractor-1", database=bridge.database)
    assert again.returncode == 1
    assert "positions of robot 'tractor-1' are stored from " in again.stderr and "nothing was" in again.stderr
    bridge.end()


def test_what_was_exported_is_imported_on_another_site_where_it_was(
    put, database, sample_site, tmp_path, new_database
):
    assert put(*UTM, "--begin", BEGIN).returncode == 0
    exported = tmp_path / "drives.gpkg"
    where = ["--site", sample_site, "--database", database]
    assert run_command("trajectories", "export", exported, *where).returncode == 0
    elsewhere = tmp_path / "turned"
    elsewhere.mkdir()
    text = (sample_site / "site.toml").read_text(encoding="utf-8")
    text = text.replace("rotation_deg = 0.0", "rotation_deg = 90.0")
    (elsewhere / "site.toml").write_text(text, encoding="utf-8")
    other = new_database("sqlite")
    done = run_command("trajectories", "import", exported, "--site", elsewhere, "--database", other)
    assert done.returncode == 0, done.stderr
    before, after = stored(database, "red", "blue"), stored(other, "red", "blue")
    assert len(before) == len(after) == 40
    for old, new in zip(before, after, strict=True):
        assert (new.robot, new.received_at, new.v) == (
            old.robot,
            pytest.approx(old.received_at, abs=1e-3),
            old.v,
        )
        assert (new.x, new.y) == pytest.approx((old.y, -old.x), abs=1e-3)


REFUSED = [
    (UTM, "its times begin at 10 s and are no dates; give when it began with --begin"),
    ([*UTM, "--begin", "2020-01-01T00:00"], "the gateway deletes what is older than 30 days"),
    ([*UTM, "--begin", "2100-01-01T00:00"], "which is not over yet"),
    (
        [*UTM, "--begin", BEGIN, "--robot", "t"],
        "has 2 robots; write --robot RECORDED=t. Recorded are red, blue",
    ),
    ([*UTM, "--begin", BEGIN, "--robot", "green=t"], "no robot is recorded as 'green'; there are red, blue"),
    ([*UTM, "--begin", BEGIN, "--robot", "red=a", "--robot", "blue=a"], "two drives would be of one robot"),
    ([*UTM, "--begin", BEGIN, "--robot", "red=a b"], "robot name 'a b' cannot be used"),
    ([*COLUMNS, "--crs", "EPSG:0", "--begin", BEGIN], "frame.crs: The CRS 'EPSG:0' is not known"),
    ([*UTM, "--column", "z"], "--column 'z' cannot be read; write it with a = between"),
    ([*UTM, "--origin", "1"], "--origin '1' cannot be read; write X,Y"),
    (["--begin", BEGIN], "row 1: no column is called x"),
]


@pytest.mark.parametrize(("options", "says"), REFUSED)
def test_what_cannot_be_imported_is_refused_and_nothing_is_written(put, database, options, says):
    done = put(*options)
    assert done.returncode == 1
    assert says in " ".join(done.stderr.split())
    assert stored(database) == []


async def test_a_drive_that_cannot_be_stored_to_its_end_is_taken_back(database):
    def fixes():
        for n in range(12_000):
            yield Fix("r1", AN_HOUR_AGO + n / 4, SendPos(float(n), 0.0, 0.0, 0.0))
        raise StoreError("the disk is full")

    opened = Database(database_address(database, None))
    await opened.open()
    try:
        await opened.run(
            trajectories.add, [trajectories.pack(Fix("r1", AN_HOUR_AGO - 1, SendPos(1, 1, 0, 0)))]
        )
        drive = RecordedDrive("r1", AN_HOUR_AGO, AN_HOUR_AGO + 3000, fixes())
        with pytest.raises(StoreError, match="disk is full"):
            await import_drives(opened, [drive], TrajectorySettings(), time.time())
        left = await opened.run(trajectories.read, TrajectoryQuery(), 1000)
    finally:
        await opened.close()
    assert [place.x for place in left] == [1.0]
