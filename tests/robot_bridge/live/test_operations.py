"""Every operation of tables II and III against a real gateway, over SQL and over WebSocket alike."""

from __future__ import annotations

import base64
import itertools
import math
import subprocess
import sys

import pyproj
import pytest
from bridge_programs import wait_until
from bridge_wires import RefusedError
from either_wire import WIRES

from robot_bridge.robotmap.binary import decode

PNG = b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 40
JPEG = b"\xff\xd8\xff\xe0" + b"jpeg" * 100
NUMBERS = itertools.count(1)


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    return start_bridge(sample_site)


@pytest.fixture(params=sorted(WIRES))
def robot(bridge, request):
    """A robot at (20, 8) that has plugged in."""
    robot = WIRES[request.param](bridge, f"{request.param}-{next(NUMBERS)}")
    robot.name = robot.ask("Ready", {"magic": 1})["robot"]
    assert decode(robot.hear("SetMap")).border == (0.0, 0.0, 200.0, 160.0)
    robot.tell("SendPos", {"x": 20.0, "y": 8.0, "theta": 0.5, "v": 0.0})
    yield robot
    robot.close()


@pytest.fixture
def desk(bridge, robot):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 50})
    desk.wait_for_robots(robot.name)
    return desk


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
    assert robot.hear("SetPath") == {"points": [[20.0, 8.0], [60.0, 20.0]], "theta": 1.5}
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


# --- SetObject, SendImage, review -------------------------------------------------------------------------


def observations(desk, robot, **wanted):
    return desk.ask("get_observations", {"robot": robot.name, **wanted})["observations"]


def objects_on_map(robot, x, y):
    """Return the obstacles around (x, y) that robots saw, by their extras' id."""
    robot.ask("GetMap", {"x": x, "y": y, "area": 100})
    seen = (o for o in decode(robot.hear("SetMap")).obstacles if o.ext.get("src", "").startswith("observ"))
    return {o.ext["id"]: o for o in seen}


def test_an_object_waits_for_review_and_is_on_the_next_maps_when_accepted(robot, desk):
    word = f"cone {robot.name}"
    robot.ask("SetObject", {"x": 100.0, "y": 80.0, "object": word, "label": "cone", "radius": 0.3, "t": 12.5})
    news = desk.until(lambda: [o for o in desk.observations.values() if o["object"] == word])
    (told,) = observations(desk, robot)
    assert told == news[0]
    assert {
        k: told[k] for k in ("robot", "op", "object", "x", "y", "state", "label", "radius", "seen_at")
    } == {
        "robot": robot.name,
        "op": "SetObject",
        "object": word,
        "x": 100.0,
        "y": 80.0,
        "state": "pending",
        "label": "cone",
        "radius": 0.3,
        "seen_at": 12.5,
    }
    assert word not in objects_on_map(robot, 100.0, 80.0)

    review = {"observation": told["observation"], "accept": True, "semantics": "traffic cone", "height": 0.75}
    reviewed = desk.ask("review_observation", review)
    assert (reviewed["state"], reviewed["reviewed_by"]) == ("accepted", "Ada")
    desk.until(lambda: desk.observations[told["observation"]] == reviewed)
    cone = objects_on_map(robot, 100.0, 80.0)[word]
    assert cone.ext == {"src": f"observation:{told['observation']}", "id": word}
    assert cone.id == 1_000_000_000 + 8 * told["observation"]
    assert cone.semantics == "traffic cone"
    assert set(cone.height) == {0.75}
    assert cone.a.mean(axis=0) == pytest.approx((100.0, 80.0), abs=0.01)
    robot.ask("Ready", {"magic": 1})
    assert word in {o.ext.get("id") for o in decode(robot.hear("SetMap")).obstacles}


def test_a_rejected_object_is_on_no_map_and_says_why(robot, desk):
    robot.ask("SetObject", {"x": 90.0, "y": 80.0, "object": f"ghost {robot.name}"})
    (told,) = observations(desk, robot, state="pending")
    desk.ask(
        "review_observation",
        {"observation": told["observation"], "accept": False, "reason": "a reflection"},
    )
    assert objects_on_map(robot, 90.0, 80.0) == {}
    (told,) = observations(desk, robot, state="rejected")
    assert told["reason"] == "a reflection"


def test_a_review_is_changed_only_on_purpose(robot, desk):
    robot.ask("SetObject", {"x": 95.0, "y": 80.0, "object": f"box {robot.name}"})
    (told,) = observations(desk, robot)
    accept = {"observation": told["observation"], "accept": True}
    first = desk.ask("review_observation", accept)
    assert desk.ask("review_observation", accept) == first
    reject = {"observation": told["observation"], "accept": False}
    with pytest.raises(RefusedError, match=r"was accepted by Ada before; give revise to change that"):
        desk.ask("review_observation", reject)
    assert f"box {robot.name}" in objects_on_map(robot, 95.0, 80.0)
    assert desk.ask("review_observation", {**reject, "revise": True})["state"] == "rejected"
    assert f"box {robot.name}" not in objects_on_map(robot, 95.0, 80.0)


def test_an_object_of_unknown_height_is_marked_as_estimated_and_has_the_sites_radius(robot, desk):
    robot.ask("SetObject", {"x": 85.0, "y": 80.0, "object": f"thing {robot.name}"})
    (told,) = observations(desk, robot)
    desk.ask("review_observation", {"observation": told["observation"], "accept": True})
    thing = objects_on_map(robot, 85.0, 80.0)[f"thing {robot.name}"]
    assert thing.ext["h"] == "est"
    assert thing.a[:, 0].max() - thing.a[:, 0].min() == pytest.approx(0.5, abs=0.05)
    desk.ask("review_observation", {"observation": told["observation"], "accept": False, "revise": True})


def test_an_image_is_kept_byte_by_byte_and_changes_no_map(robot, desk):
    robot.ask("SendImage", {"x": 10.0, "y": 80.0, "object": f"cone {robot.name}"}, PNG)
    (told,) = observations(desk, robot)
    assert (told["op"], told["media_type"], told["image_bytes"]) == ("SendImage", "image/png", len(PNG))
    image = desk.ask("get_image", {"observation": told["observation"]})
    assert image["media_type"] == "image/png"
    assert base64.b64decode(image["image"]) == PNG
    reviewed = desk.ask("review_observation", {"observation": told["observation"], "accept": True})
    assert reviewed["state"] == "accepted"
    assert objects_on_map(robot, 10.0, 80.0) == {}
    with pytest.raises(RefusedError, match="is an image, which is not drawn on the map"):
        desk.ask(
            "review_observation",
            {"observation": told["observation"], "accept": True, "height": 1.0, "revise": True},
        )


@pytest.mark.parametrize(
    ("image", "params", "reason"),
    [
        (
            b"GIF89a....",
            {},
            r"image begins with 47 49 46 38 39 61 2e 2e, which is neither JPEG, PNG nor WebP",
        ),
        (b"", {}, r"image begins with nothing"),
        (JPEG, {"media_type": "image/png"}, r"media_type is 'image/png', and the bytes are image/jpeg"),
        (PNG + bytes(4_000_000), {}, r"the image has 4010248 bytes, and this site takes up to 4000000"),
    ],
)
def test_what_is_no_image_or_too_large_is_refused(robot, desk, image, params, reason):
    with pytest.raises(RefusedError, match=reason):
        robot.ask("SendImage", {"x": 10.0, "y": 80.0, "object": "cone", **params}, image)
    assert observations(desk, robot) == []


def test_what_is_told_again_under_the_same_source_is_stored_once(robot, desk):
    for t in (1.0, 2.0):
        robot.ask("SetObject", {"x": 70.0, "y": 80.0, "object": "a", "source": "7", "t": t})
    robot.ask("SetObject", {"x": 70.5, "y": 80.0, "object": "a", "source": "7"})
    robot.ask("SetObject", {"x": 70.0, "y": 80.0, "object": "a"})
    robot.ask("SendImage", {"x": 70.0, "y": 80.0, "object": "a", "source": "7"}, PNG)
    robot.ask("SendImage", {"x": 70.0, "y": 80.0, "object": "a", "source": "7"}, JPEG)
    assert [(o["op"], o["x"]) for o in observations(desk, robot)] == [
        ("SendImage", 70.0),
        ("SendImage", 70.0),
        ("SetObject", 70.0),
        ("SetObject", 70.5),
        ("SetObject", 70.0),
    ]


def test_observations_are_read_in_pages(robot, desk):
    for number in range(5):
        robot.ask("SetObject", {"x": 70.0 + number, "y": 70.0, "object": str(number)})
    first = observations(desk, robot, limit=2)
    second = observations(desk, robot, limit=2, before=first[-1]["observation"])
    last = observations(desk, robot, limit=2, before=second[-1]["observation"])
    assert [o["object"] for o in first + second + last] == ["4", "3", "2", "1", "0"]


def test_what_is_not_there_cannot_be_reviewed_or_looked_at(bridge):
    desk = bridge.desk()
    with pytest.raises(RefusedError, match="there is no observation 987654"):
        desk.ask("review_observation", {"observation": 987654, "accept": True})
    with pytest.raises(RefusedError, match="observation 987654 has no image"):
        desk.ask("get_image", {"observation": 987654})


def test_what_was_accepted_is_on_the_map_after_a_power_cut(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    robot = WIRES["websocket"](bridge, "seer")
    robot.ask("Ready", {"magic": 1})
    robot.hear("SetMap")
    for number in range(20):
        robot.ask("SetObject", {"x": 50.0 + number, "y": 80.0, "object": str(number)})
    robot.ask("SendImage", {"x": 50.0, "y": 80.0, "object": "0"}, PNG)
    desk = bridge.desk()
    told = desk.ask("get_observations")["observations"]
    for each in told[1:11]:
        desk.ask("review_observation", {"observation": each["observation"], "accept": True})
    bridge.kill_gateway()
    bridge.start_gateway()
    after = bridge.desk().ask("get_observations")["observations"]
    assert [o["object"] for o in after] == [o["object"] for o in told]
    assert sum(o["state"] == "accepted" for o in after) == 10
    again = WIRES["websocket"](bridge, "seer")
    again.ask("Ready", {"magic": 1})
    on_map = {o.ext.get("id") for o in decode(again.hear("SetMap")).obstacles} - {None}
    assert on_map == {str(number) for number in range(10, 20)}
    bridge.end()


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
    desk.until(lambda: name in desk.robots)
    desk.wait_for_robots(name)
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
    command = [
        sys.executable,
        "-m",
        "robot_bridge",
        "robot",
        "--name",
        "r1",
        "--url",
        "ws://127.0.0.1:1/robot",
    ]
    done = subprocess.run([*command, *options], capture_output=True, text=True, timeout=30)
    assert done.returncode == 1
    assert text in done.stderr
    assert done.stderr.startswith("robot-bridge: ")
    assert done.stderr.count("\n") == 1
