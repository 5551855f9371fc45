"""Every operation of tables II and III against a real gateway, over SQL and over WebSocket alike."""

from __future__ import annotations

import math
from itertools import pairwise

import pyproj
import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError
from tests.support.bridge.command_line import run_command

PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


def earth(desk, x, y):
    """Return longitude and latitude of a place on the site, by PROJ's own pipeline."""
    site = desk.site
    to_earth = pyproj.Transformer.from_crs(site["crs"], 4326, always_xy=True)
    c, s = math.cos(site["rotation"]), math.sin(site["rotation"])
    return to_earth.transform(site["origin"][0] + c * x - s * y, site["origin"][1] + s * x + c * y)


def seen(desk, robot, **wanted):
    """Wait until operators are told this of the robot."""
    desk.until(lambda: wanted.items() <= desk.robots[robot.name].items())
    return desk.robots[robot.name]


# --- SendGPS ----------------------------------------------------------------------------------------------


def test_a_gps_position_becomes_a_pose_in_the_site_frame(robot, desk):
    lon, lat = earth(desk, 61.0, 42.0)
    robot.tell(
        "SendGPS", {"lat": lat, "lon": lon, "heading": 90, "v": 1.5, "accuracy": 0.4, "altitude": 250.5}
    )
    report = seen(desk, robot, v=1.5)
    assert (report["x"], report["y"]) == pytest.approx((61.0, 42.0), abs=0.002)
    # East of the middle meridian the map's north lies west of true north.
    convergence = pyproj.Proj(desk.site["crs"]).get_factors(lon, lat).meridian_convergence
    assert report["theta"] == pytest.approx(math.radians(convergence), abs=1e-3)
    assert abs(convergence) > 0.5
    assert (report["accuracy"], report["altitude"]) == (0.4, 250.5)
    assert "theta_from" not in report


def test_without_a_heading_the_last_theta_is_kept_and_then_the_course(robot, desk):
    for second, x in enumerate((20.0, 20.1, 25.0, 30.0)):
        lon, lat = earth(desk, x, 8.0)
        robot.tell("SendGPS", {"lat": lat, "lon": lon, "fix_t": 1000.0 + second})
        if x == 20.1:
            assert seen(desk, robot, theta_from="last")["theta"] == 0.5
    report = desk.until(lambda: (r := desk.robots[robot.name])["x"] > 29 and r)
    assert (report["theta"], report["v"]) == pytest.approx((0.0, 5.0), abs=0.01)
    assert report["theta_from"] == "course"


def test_a_gps_position_that_has_no_place_on_the_site_frame_is_refused(robot):
    with pytest.raises(RefusedError, match=r"SendGPS: latitude 0.000000, longitude 105.000000 has no place"):
        robot.ask("SendGPS", {"lat": 0, "lon": 105})


def test_a_gps_position_with_latitude_and_longitude_swapped_is_refused_and_named_so(robot, desk):
    lon, lat = earth(desk, 61.0, 42.0)
    with pytest.raises(RefusedError, match="latitude and longitude look swapped"):
        robot.ask("SendGPS", {"lat": lon, "lon": lat})
    robot.tell("SendGPS", {"lat": lat, "lon": lon})
    assert seen(desk, robot, theta_from="last")["x"] == pytest.approx(61.0, abs=0.002)


# --- SetPosIni, GetPosIni, GetPosEnd ----------------------------------------------------------------------


def test_a_beginning_is_reached_when_the_robot_says_that_it_is_there(robot, desk):
    id = f"begin-{robot.name}"
    desk.send(id, robot.name, "SetPosIni", x=30.0, y=8.0, theta=1.0)
    assert robot.hear("SetPosIni") == {"x": 30.0, "y": 8.0, "theta": 1.0}
    desk.wait_for_step(id, "acknowledged")
    robot.tell("SendPos", {"x": 30.05, "y": 8.0, "theta": 0.5, "v": 0.0})
    robot.tell("SendPos", {"x": 30.1, "y": 8.0, "theta": 1.0, "v": 0.4})
    assert desk.wait_for_step(id, "reached")["deviation"] == pytest.approx(0.1)
    robot.ask("GetPosIni", {})
    assert robot.hear("SetPosIni") == {"x": 30.0, "y": 8.0, "theta": 1.0}


def test_a_beginning_leaves_the_task_alone_and_makes_an_older_beginning_void(robot, desk):
    first, task, second = (f"{word}-{robot.name}" for word in ("first-begin", "the-task", "second-begin"))
    desk.send(first, robot.name, "SetPosIni", x=30.0, y=8.0)
    desk.send(task, robot.name, "SetPosEnd", x=60.0, y=8.0)
    desk.send(second, robot.name, "SetPosIni", x=40.0, y=8.0)
    desk.wait_for_step(first, "superseded")
    robot.hear("SetPosEnd")
    desk.wait_for_step(task, "acknowledged")
    robot.ask("GetPosIni", {})
    heard = [robot.hear("SetPosIni")["x"], robot.hear("SetPosIni")["x"]]
    assert heard[-1] == 40.0


def test_a_beginning_off_the_site_is_refused(robot, desk):
    with pytest.raises(RefusedError, match=r"\(300.00, 8.00\) lies outside site"):
        desk.send(f"off-site-{robot.name}", robot.name, "SetPosIni", x=300.0, y=8.0)


def test_the_ends_of_a_drawn_path_are_the_ends_of_the_track(robot, desk):
    id = f"path-{robot.name}"
    desk.send(id, robot.name, "SetPath", points=[[20, 8], [40, 8], [44, 12]], theta=1.0)
    assert robot.hear("SetPath")["theta"] == 1.0
    robot.ask("GetPosIni", {})
    assert robot.hear("SetPosIni") == {"x": 20.0, "y": 8.0}
    robot.ask("GetPosEnd", {})
    assert robot.hear("SetPosEnd") == {"x": 44.0, "y": 12.0, "theta": 1.0, "cone": False}
    desk.wait_for_step(id, "acknowledged")


def test_an_end_that_was_given_up_is_not_given_again(robot, desk):
    id = f"end-{robot.name}"
    desk.send(id, robot.name, "SetPosEnd", x=60.0, y=8.0)
    robot.hear("SetPosEnd")
    robot.ask("GetPosEnd", {})
    assert robot.hear("SetPosEnd")["x"] == 60.0
    desk.send(f"abort-{robot.name}", robot.name, "Abort")
    robot.hear("Abort")
    desk.wait_for_step(id, "aborted")
    with pytest.raises(RefusedError, match=r"GetPosEnd: the last SetPosEnd of robot .* is aborted; wait for"):
        robot.ask("GetPosEnd", {})
    with pytest.raises(RefusedError, match=r"GetPath: robot .* has no task"):
        robot.ask("GetPath", {})


# --- GetPath ----------------------------------------------------------------------------------------------


def test_the_path_to_a_target_begins_where_the_robot_is(robot, desk):
    id = f"target-{robot.name}"
    desk.send(id, robot.name, "SetPosEnd", x=60.0, y=20.0, theta=1.5)
    robot.hear("SetPosEnd")
    desk.wait_for_step(id, "acknowledged")
    robot.ask("GetPath", {})
    told = robot.hear("SetPath")
    assert (told["points"][0], told["points"][-1], told["theta"]) == ([20.0, 8.0], [60.0, 20.0], 1.5)
    steps = [math.dist(a, b) for a, b in pairwise(told["points"])]
    # Along the roads it is farther than the 41.8 m across the grass.
    assert max(steps) < 0.51
    assert 45.0 < sum(steps) < 60.0
    robot.tell("SendPos", {"x": 60.0, "y": 20.05, "theta": 1.5, "v": 0.0})
    assert desk.wait_for_step(id, "reached")["deviation"] == pytest.approx(0.05)


def test_of_a_drawn_path_what_lies_ahead_is_told(robot, desk):
    id = f"drawn-{robot.name}"
    desk.send(id, robot.name, "SetPath", points=[[20, 8], [40, 8], [40, 30]])
    robot.hear("SetPath")
    desk.wait_for_step(id, "acknowledged")
    for x in (22.0, 25.0, 28.0, 31.0):
        robot.tell("SendPos", {"x": x, "y": 8.5, "theta": 0.0, "v": 3.0})
        seen(desk, robot, x=x)
    robot.ask("GetPath", {})
    assert robot.hear("SetPath")["points"] == [[31.0, 8.5], [31.0, 8.0], [40.0, 8.0], [40.0, 30.0]]


# --- the reference robot ----------------------------------------------------------------------------------


@pytest.mark.parametrize("sql", [False, True], ids=["websocket", "sql"])
def test_the_reference_robot_tells_what_it_sees_and_asks_for_its_path(bridge, tmp_path, sql):
    picture = tmp_path / "cone.png"
    picture.write_bytes(PNG)
    name = f"reference-{'sql' if sql else 'ws'}"
    bridge.start_robot(
        name, (20.0, 8.0, 0.0), sql=sql, options=["--see", "45,8,cone-7", "--image", picture, "--ask-path"]
    )
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    # A process of its own, which has to import all it needs on a computer that may be busy.
    desk.wait_for_robots(name, seconds=60)
    desk.send(f"begin-{name}", name, "SetPosIni", x=22.0, y=8.0)
    desk.wait_for_step(f"begin-{name}", "reached")
    desk.send(f"drive-{name}", name, "SetPosEnd", x=45.0, y=8.0)
    desk.wait_for_step(f"drive-{name}", "reached")
    told = wait_until(lambda: (o := desk.ask("get_observations", {"robot": name})["observations"])[1:] and o)
    assert [(o["op"], o["object"]) for o in told] == [("SendImage", "cone-7"), ("SetObject", "cone-7")]
    assert math.hypot(told[0]["x"] - 45, told[0]["y"] - 8) <= 10.1


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--see", "45,8"], "thing '45,8' cannot be read"),
        (["--see", "45,8,"], "object is ''; give 1 to 128 printable characters"),
        (["--see", "here,8,cone"], "write X,Y,ID such as 10,20,cone-7"),
        (["--image", "no-such-file.png"], "image no-such-file.png cannot be read: No such file"),
    ],
)
def test_what_the_reference_robot_is_to_see_is_checked(options, text):
    done = run_command("robot", "--name", "r1", "--url", "ws://127.0.0.1:1/robot", *options)
    assert done.returncode == 1
    assert text in done.stderr
    assert done.stderr.startswith("robot-bridge: ")
    assert done.stderr.count("\n") == 1
