"""The guide for recordings as it is written: a real gateway, the real adapter."""

from __future__ import annotations

import gzip
import re
import shlex
import struct
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError
from tests.support.bridge.command_line import run_command

GUIDE = (Path(__file__).parents[4] / "docs/links-replay.md").read_text(encoding="utf-8")
SETTINGS = re.findall(r"```toml\n(.*?)```", GUIDE, re.DOTALL)
(TABLE,) = re.findall(r"```csv\n(.*?)```", GUIDE, re.DOTALL)
RED, BLUE = "replay-red", "replay-blue"


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def config(bridge, tmp_path):
    """Write the settings of the guide: ``config(number, more)``."""
    (tmp_path / "cars.csv").write_text(TABLE, encoding="utf-8")
    gateway = f'[gateway]\nurl = "{bridge.address}/link"\n'

    def write(text):
        file = tmp_path / "cars.toml"
        file.write_text(f"{gateway}\n{text}", encoding="utf-8")
        return file

    return write


@pytest.fixture
def desk(bridge):
    return desk_of(bridge)


def desk_of(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    return desk


def x_of(desk, name):
    desk.listen(0.05)
    return desk.robots.get(name, {}).get("x") or 0.0


def says(desk, text):
    desk.listen(0.05)
    return text in desk.robots.get(RED, {}).get("status", "")


def test_a_recording_is_played_as_the_guide_says_to_its_end(bridge, desk, config):
    adapter = bridge.start_link("replay", config(SETTINGS[0]))
    desk.wait_for_robots(RED, BLUE)
    begin = desk.robots[BLUE]["x"]
    assert desk.robots[RED]["link"] == "cars"
    assert desk.robots[RED]["status"] == "replay of cars.csv ×1"
    with pytest.raises(RefusedError, match="is only seen"):
        desk.send("go-to-red", RED, "SetPosEnd", x=40.0, y=8.0)
    stopped = desk.ask("emergency_stop", {"command": "stop-of-replays"})
    desk.ask("clear_emergency_stop", {})
    assert (stopped["robots"], stopped["waiting"]) == (0, [])
    # 0.0007° of longitude are 53 m at this latitude; the heading is from the movement.
    wait_until(lambda: x_of(desk, BLUE) == pytest.approx(begin + 53.3, abs=0.5), 15)
    assert desk.robots[BLUE]["theta_from"] == "course" and abs(desk.robots[BLUE]["theta"]) < 0.05
    assert desk.robots[BLUE]["v"] == pytest.approx(10.7, abs=0.1)
    assert adapter.poll() is None
    adapter.kill()
    adapter.wait(5)


def test_settings_change_what_is_played_and_a_gateway_that_was_killed_sees_it_again(bridge, desk, config):
    text = f"{SETTINGS[0]}loop = true\nspeed = 5\n"
    adapter = bridge.start_link("replay", config(text))
    wait_until(lambda: x_of(desk, BLUE), 15)
    wait_until(lambda: says(desk, "replay of cars.csv ×5"), 10)
    config(f"{text}paused = true\nstart_s = 5.0\n")
    wait_until(lambda: says(desk, "paused"), 10)
    assert desk.robots[RED]["v"] == 0.0
    config("[replay]\nspeed = 'fast'\n")

    bridge.kill_gateway()
    bridge.start_gateway()
    desk = desk_of(bridge)
    desk.wait_for_robots(RED, BLUE)
    wait_until(lambda: says(desk, "paused"), 10)
    config(text)
    wait_until(lambda: not says(desk, "paused"), 10)

    adapter.kill()
    adapter.wait(5)
    desk.until(lambda: desk.robots[RED]["state"] == "lost", 10)
    again = bridge.start_link("replay", config(f"{SETTINGS[0]}largest_gap_s = 1.0\n"))
    desk.until(lambda: desk.robots[RED]["state"] == "fresh", 15)
    desk.until(lambda: desk.robots[RED]["state"] == "offline", 15)
    again.kill()
    again.wait(5)


def test_a_desk_seeks_pauses_and_speeds_up_what_is_played(bridge, desk, config):
    adapter = bridge.start_link("replay", config(f"{SETTINGS[0]}speed = 0.1\nlargest_gap_s = 100\n"))

    def play(**change):
        return desk.ask("set_playback", {"link": "cars", **change})

    wait_until(lambda: not _is_refused(play, "connected"), 15)
    told = play()
    assert (told["file"], told["speed"], told["paused"], told["length_s"]) == ("cars.csv", 0.1, False, 5.0)
    assert play(paused=True, place_s=0.0)["place_s"] == 0.0
    wait_until(lambda: says(desk, "×0.1, paused"), 15)
    begin = x_of(desk, BLUE)
    assert play(place_s=5.0)["place_s"] == 5.0
    wait_until(lambda: x_of(desk, BLUE) == pytest.approx(begin + 53.3, abs=0.5), 10)
    assert play(place_s=0.0)["place_s"] == 0.0
    wait_until(lambda: x_of(desk, BLUE) == pytest.approx(begin, abs=0.5), 10)
    assert not play(paused=False, speed=10.0, loop=True)["paused"]
    wait_until(lambda: says(desk, "replay of cars.csv ×10"), 10)
    for wrong, why in (
        ({"place_s": 6.0}, r"link cars: place_s = 6: the recording is 5\.0 s long"),
        ({"speed": 5000.0}, r"replay\.speed = 5000.0: give a number from 0\.1 to 1000"),
        ({"link": "phones"}, r"'phones' plays no recording; those that do: cars"),
    ):
        with pytest.raises(RefusedError, match=why):
            play(**wrong)
    assert play()["speed"] == 10.0
    adapter.kill()
    adapter.wait(5)
    wait_until(lambda: _is_refused(play, "it is not connected"), 10)


def _is_refused(work, why):
    try:
        work()
    except RefusedError as error:
        return why in str(error)
    return False


WRONG = [
    ("file = 'none.csv'", r"none\.csv cannot be read: No such file"),
    ("file = 'cars.docx'", r"cars\.docx is of no kind that is read; known are \.csv, \.gpx"),
    ("file = 'cars.csv'\nspeed = 5000", r"cars\.toml: replay\.speed = 5000.*from 0\.1 to 1000"),
    ("file = 'cars.csv'\nstart_s = 60.0", r"replay\.start_s = 60: the recording is 5\.0 s long"),
    ("file = 'cars.csv'\ncolumns = {pose = 'x'}", r"replay\.columns\.pose is not known; known are time"),
    ("file = 'cars.csv'\ncolumns = {x = 'x', lat = 'y'}", r"replay\.columns: give x and y, or lat and lon"),
    (
        "file = 'cars.csv'\ncolumns = {x = 'easting'}",
        r"row 1: columns\.x: no column is called easting; there are",
    ),
    ("file = 'cars.csv'\ncolumns = {x = '{robot}_x'}", r"row 1: no column is called like \{robot\}_x"),
    (
        "file = 'cars.csv'\nrobots = {green = 'g'}",
        r"replay\.robots\.green: no robot is recorded so; there are red",
    ),
    ("file = 'cars.csv'\nrobots = {red = 'blue'}", r"replay\.robots: two robots would have one name"),
    ("file = 'cars.csv'\ntime_unit = 'h'", r"replay\.time_unit = 'h': give one of s, ms, us, ns"),
]


@pytest.mark.parametrize(("text", "says"), WRONG)
def test_settings_that_cannot_be_used_are_named(config, text, says):
    from robot_bridge.links.base.errors import LinkError
    from robot_bridge.links.replay.adapter import load

    with pytest.raises(LinkError, match=says):
        load(config(f"[replay]\n{text}\n"))


def write_bag(folder):
    """Write a bag with one Odometry, all of it nought but for the rotation."""
    pytest.importorskip("rosbags.highlevel")
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    # Encapsulation, header, child frame, position and orientation; covariance and twist are nought.
    data = b"\0\1\0\0" + bytes(8) + b"\1\0\0\0\0\0\0\0" + b"\1\0\0\0\0\0\0\0"
    data += struct.pack("<7d", 1, 2, 0, 0, 0, 0, 1) + bytes(8 * (36 + 6 + 36))
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as bag:
        bag.write(bag.add_connection("/r1/odom", "nav_msgs/msg/Odometry", typestore=store), 10**18, data)


def test_all_settings_of_the_guide_can_be_used(config, tmp_path):
    (tmp_path / "six.csv.gz").write_bytes(
        gzip.compress(b"t_s,vehicle,x_utm33,y_utm33,course,speed_mps\n0.1,1,640420,5193480,0,1\n")
    )
    (tmp_path / "wide.csv").write_text(
        "time;a_x;a_y;a_heading;b_x;b_y;b_heading\n0;1;2;90;;;\n100;1;2;90;3;4;0\n"
    )
    write_bag(tmp_path / "bag")
    (tmp_path / "bag/bag.mcap").rename(tmp_path / "drive.mcap")
    for text in SETTINGS:
        done = run_command("link", "replay", "--config", config(text), "--check")
        assert done.returncode == 0 and not done.stderr, done.stderr


def test_a_drive_is_put_into_the_database_as_the_guide_says(new_database, sample_site, config, tmp_path):
    (command,) = re.findall(r"^    robot-bridge (trajectories import .*)$", GUIDE, re.MULTILINE)
    words = shlex.split(re.sub(r"\d{4}-\S+", f"{datetime.now(UTC) - timedelta(hours=1):%FT%T}", command))
    (tmp_path / "links").mkdir()
    (tmp_path / "links/cars.csv").write_text(TABLE, encoding="utf-8")
    (tmp_path / "site").symlink_to(sample_site)
    paths = [tmp_path / word if word in ("site", "links/cars.csv") else word for word in words]
    done = run_command(*paths, "--database", new_database("sqlite"))
    assert done.returncode == 0 and "5 positions stored of 7" in done.stdout, done.stdout + done.stderr
