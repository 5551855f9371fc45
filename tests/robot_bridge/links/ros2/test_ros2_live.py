"""Real rclpy robots through a real gateway, as operators see them; adapter, node and gateway are killed."""

from __future__ import annotations

import base64
import io
import itertools
import re

import pytest
from PIL import Image

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.cut_line import CutNetwork, outlast_a_cut
from tests.support.bridge.link_process import LinkProcess
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.robots.ros_nodes import abort_before_the_goal, events

SETTINGS = """
[gateway]
url = "{address}/link"

[ros2]
domain = {domain}
range = "localhost"
distribution = "{distribution}"

image_every_s = 1
{resolution}

[ros2.topics]
stop = "/{{robot}}/stop"
place_cone = "/{{robot}}/place_cone"
map = "/{{robot}}/map"
get_map = "/{{robot}}/get_map"
image = "/{{robot}}/camera"
keepout_mask = "/{{robot}}/keepout_mask"
keepout_info = "/{{robot}}/keepout_info"
speed_mask = "/{{robot}}/speed_mask"
speed_info = "/{{robot}}/speed_info"
"""
COARSE = "map_resolution_m = 2.0"
"""Each robot reads three maps, which at 0.1 m have 400 times as many cells."""
NUMBERS = itertools.count(1)
SLOW, FAST = ("--speed", "0.5"), ("--speed", "10")


def ros2_link(processes, file):
    """An adapter with memory that a hostile peer would soon use up."""
    return LinkProcess(processes, "ros2", file, 3_000_000_000)


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site, nodes):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture(scope="module")
def adapter(bridge, nodes, tmp_path_factory):
    folder = tmp_path_factory.mktemp("links")
    file = folder / "nav2.toml"
    file.write_text(
        SETTINGS.format(
            address=bridge.address, domain=nodes.domain, distribution=nodes.distribution, resolution=COARSE
        )
    )
    with Processes(folder / "logs") as processes:
        adapter = ros2_link(processes, file)
        adapter.start()
        yield adapter


@pytest.fixture
def desk(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 10})
    yield desk
    # What nobody reads any more would be sent all the same.
    desk.hang_up()


@pytest.fixture
def robot(adapter, nodes, desk):
    """Start a robot that no other test has: ``robot(*options)`` returns its name when seen, and able."""
    started = []

    def start(*options, seen=True, able="targets", **more):
        name = f"robot{next(NUMBERS)}"
        nodes.start(name, *options, **more)
        started.append(name)
        if seen:
            desk.wait_for_robots(name, seconds=BUSY * 10)
            desk.wait_for_abilities(name, able)
        return name

    yield start
    for name in started:
        nodes.end(name)


def steps(desk, command):
    reports = desk.ask("get_commands", {})["commands"]
    (report,) = [one for one in reports if one["command"] == command]
    return report["steps"]


def test_a_cone_target_is_driven_reached_and_placed(desk, robot, nodes):
    name = robot(*FAST, able="cones")
    assert desk.robots[name]["x"] == pytest.approx(20.0)
    desk.until(lambda: desk.robots[name].get("battery") == 0.75, 20)
    desk.send(f"go-{name}", name, "SetPosEnd", x=40.0, y=8.0, cone=True)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    desk.wait_for_step(f"go-{name}", "reached", 8)
    (cone,) = wait_until(lambda: events(nodes, name, "cone"))
    assert (cone["x"], cone["y"]) == pytest.approx((40.0, 8.0))


def test_a_route_is_followed_point_by_point(desk, robot, nodes):
    name = robot(*FAST, able="paths")
    points = [[20.0, 8.0], [30.0, 8.0], [30.0, 12.0]]
    desk.send(f"path-{name}", name, "SetPath", points=points)
    desk.wait_for_step(f"path-{name}", "reached", 8)
    (goal,) = events(nodes, name, "goal")
    assert goal["kind"] == "FollowPath" and goal["points"] == points


@pytest.mark.parametrize(
    ("action", "kind"),
    [("navigate_through_poses", "NavigateThroughPoses"), ("follow_waypoints", "FollowWaypoints")],
)
def test_a_route_is_driven_by_what_the_robot_offers(desk, robot, nodes, action, kind):
    name = robot(*FAST, "--actions", action, able="paths")
    points = [[20.0, 8.0], [22.0, 8.0], [22.0, 10.0]]
    desk.send(f"path-{name}", name, "SetPath", points=points)
    desk.wait_for_step(f"path-{name}", "reached", 8)
    (goal,) = events(nodes, name, "goal")
    assert goal["kind"] == kind and goal["points"] == points


def test_a_route_whose_points_were_missed_has_failed(desk, robot):
    name = robot(*FAST, "--actions", "follow_waypoints", "--odd", "misses", able="paths")
    desk.send(f"path-{name}", name, "SetPath", points=[[20.0, 8.0], [22.0, 8.0], [22.0, 10.0]])
    desk.wait_for_step(f"path-{name}", "failed", 8)
    assert "left out points of the path: 3" in steps(desk, f"path-{name}")[-1]["reason"]


def test_an_image_is_one_observation_at_the_place_of_its_robot(desk, robot, adapter):
    name, bad = robot("--image", "raw"), robot("--image", "depth")
    wait_until(lambda: f"robot {bad}: /{bad}/camera: its image is 'depth'" in adapter.output(), 20)
    (seen,) = wait_until(lambda: desk.ask("get_observations", {"robot": name})["observations"], 20)
    assert (seen["op"], seen["object"], seen["media_type"]) == ("SendImage", "front_camera", "image/png")
    assert (seen["x"], seen["y"]) == pytest.approx((20.0, 8.0))
    content = base64.b64decode(desk.ask("get_image", {"observation": seen["observation"]})["image"])
    image = Image.open(io.BytesIO(content))
    assert [image.getpixel((x, 0)) for x in range(3)] == [(255, 0, 0), (255, 0, 0), (0, 0, 255)]


def test_nav2_that_is_started_later_makes_its_robot_able(desk, robot, nodes):
    name = robot("--odd", "no-actions")
    desk.until(lambda: "paths" not in (desk.robots[name].get("abilities") or ""), 20)
    nodes.start(f"{name}-nav2", *FAST, "--odd", "silent", node=name)
    try:
        desk.wait_for_abilities(name, "paths")
    finally:
        nodes.end(f"{name}-nav2")


def test_the_map_of_the_site_comes_latched_with_masks_for_the_filters_of_nav2(robot, nodes, adapter):
    name = robot("--asks-map")
    told = wait_until(lambda: events(nodes, name, "map"), 30)
    assert (told[0]["columns"], told[0]["rows"], told[0]["frame"]) == (100, 80, "map")

    # Each comes twice where the robot is declared twice: on a busy machine its servers are found one by one.
    def latest(event, key):
        return {one[key]: one for one in events(nodes, name, event)}

    wait_until(lambda: len(latest("mask", "name")) == 2 and len(latest("filter", "mask")) == 2, 40)
    masks = latest("mask", "name")
    assert {(one["columns"], one["rows"]) for one in masks.values()} == {(100, 80)}
    assert masks["keepout"]["cells"] == {"road": 0, "excavation": 100}
    filters = latest("filter", "mask")
    assert filters[f"/{name}/keepout_mask"]["type"] == 0
    speeds, speed = masks["speed"]["cells"], filters[f"/{name}/speed_mask"]
    assert (speed["type"], speeds["excavation"]) == (2, 0)
    assert speeds["road"] * speed["multiplier"] == pytest.approx(1.0)
    wait_until(lambda: f"robot {name}: a node on Fast DDS asks for the map" in adapter.output())


def test_an_abort_cancels_what_nav2_does_and_the_robot_stands(desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    wait_until(lambda: events(nodes, name, "led"), 30)
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "acknowledged")
    desk.wait_for_step(f"go-{name}", "aborted")
    assert events(nodes, name, "cancel asked") and events(nodes, name, "stop")
    wait_until(lambda: events(nodes, name, "zero twist"))
    assert events(nodes, name, "goal ended")[0]["status"] == 5


def test_a_goal_that_is_taken_on_after_its_abort_is_stopped_too(desk, robot, nodes):
    name = robot(*SLOW, "--odd", "late-goals")
    abort_before_the_goal(desk, nodes, name)


def test_an_emergency_stop_stops_and_is_cleared(desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    desk.ask("emergency_stop", {"command": f"emergency-{name}"})
    desk.ask("emergency_stop", {"command": f"again-{name}"})
    try:
        desk.until(lambda: desk.emergency["in_force"] and name not in desk.emergency["waiting"], 10)
        assert events(nodes, name, "goal ended")[0]["status"] == 5
    finally:
        desk.ask("clear_emergency_stop", {})
    desk.send(f"on-{name}", name, "SetPosEnd", x=desk.robots[name]["x"] + 0.5, y=8.0)
    desk.wait_for_step(f"on-{name}", "reached", 8)


def test_a_robot_that_will_not_stop_is_told_to_operators(desk, robot):
    name = robot(*SLOW, "--odd", "stubborn")
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "failed", 4)
    assert "was not confirmed within 5 s" in steps(desk, f"stop-{name}")[-1]["reason"]
    desk.until(lambda: "Stop it on site" in (desk.robots[name].get("status") or ""), 20)


@pytest.mark.parametrize(
    ("odd", "words"), [("rejects", "rejected the goal"), ("fails", "a test asked for it (error 9003)")]
)
def test_why_a_robot_does_not_drive_is_told(desk, robot, odd, words):
    name = robot("--odd", odd)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "failed")
    assert words in steps(desk, f"go-{name}")[-1]["reason"]


def test_a_robot_without_actions_drives_to_what_is_published(desk, robot, nodes):
    name = robot(*FAST, "--odd", "no-actions")
    desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert events(nodes, name, "goal pose")[0]["points"] == [[25.0, 8.0]]


@pytest.mark.parametrize(
    ("odd", "words"),
    [
        ("nan", r"position\.x is nan"),
        ("other-frame", "frame 'elsewhere' is not connected with 'map'"),
        # A day, and what the first message took: on a busy machine a second and more.
        ("old-clock", r"its clock is 864\d\d s behind"),
    ],
)
def test_what_is_wrong_with_one_robot_is_named_and_the_others_go_on(desk, robot, adapter, odd, words):
    name = robot("--odd", odd, seen=odd == "old-clock")
    wait_until(lambda: re.search(f"robot {name}: .*{words}", adapter.output()), 30)
    other = robot(*FAST)
    assert desk.robots[other]["state"] == "fresh"


def test_two_nodes_of_one_name_are_named_and_both_are_stopped(desk, robot, nodes, adapter):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    nodes.start(f"{name}-twin", *SLOW, node=name)
    try:
        wait_until(lambda: f"robot {name}: 2 nodes publish /{name}/odom" in adapter.output(), 30)
        wait_until(lambda: f"2 nodes serve /{name}/navigate_to_pose" in adapter.output(), 30)
        desk.send(f"stop-{name}", name, "Abort")
        wait_until(lambda: events(nodes, name, "stop") and events(nodes, f"{name}-twin", "stop"))
        desk.wait_for_step(f"stop-{name}", "acknowledged")
        assert events(nodes, name, "goal ended")[0]["status"] == 5
    finally:
        nodes.end(f"{name}-twin")


def test_actions_of_another_distribution_are_named_and_the_rest_is_used(bridge, nodes, desk, tmp_path):
    # With the map as fine as it is where nobody says how fine: 3 MB in many parts.
    text = SETTINGS.format(
        address=bridge.address, domain=nodes.other_domain, distribution="lyrical", resolution=""
    )
    file = tmp_path / "other.toml"
    file.write_text(text, encoding="utf-8")
    name = f"robot{next(NUMBERS)}"
    with Processes(tmp_path / "logs") as processes:
        other = ros2_link(processes, file)
        other.start()
        nodes.start(name, *FAST, domain=nodes.other_domain)
        wait_until(lambda: f"/{name}/follow_path has the FollowPath of jazzy or kilted" in other.output(), 30)
        desk.wait_for_abilities(name, "targets")
        assert "paths" not in desk.robots[name]["abilities"]
        desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
        desk.wait_for_step(f"go-{name}", "reached", 10)
        (told, *_) = wait_until(lambda: events(nodes, name, "map"), 30)
        assert (told["columns"], told["rows"], told["frame"]) == (2000, 1600, "map")
        nodes.end(name)


def test_a_goal_that_is_taken_on_too_late_is_not_driven(bridge, nodes, desk, tmp_path):
    """Its command has failed by then."""
    name, file = f"robot{next(NUMBERS)}", tmp_path / "hasty.toml"
    settings = SETTINGS.format(
        address=bridge.address, domain=nodes.other_domain, distribution=nodes.distribution, resolution=COARSE
    )
    settings = settings.replace("image_every_s", "hold_s = 0.0\nimage_every_s")
    file.write_text(f"answer_within_s = 0.5\n{settings}", encoding="utf-8")
    with Processes(tmp_path / "logs") as processes:
        ros2_link(processes, file).start()
        nodes.start(name, *SLOW, "--odd", "late-goals", domain=nodes.other_domain)
        desk.wait_for_robots(name, seconds=BUSY * 10)
        desk.wait_for_abilities(name, "targets")
        desk.send(f"go-{name}", name, "SetPosEnd", x=90.0, y=8.0)
        desk.wait_for_step(f"go-{name}", "failed")
        assert "did not take it on within 0.5 s" in steps(desk, f"go-{name}")[-1]["reason"]
        wait_until(lambda: events(nodes, name, "goal ended"), 10)
        assert desk.robots[name]["x"] < 30.0
        nodes.end(name)


def test_a_node_that_is_killed_and_started_anew_is_sent_again_what_is_open(desk, robot, nodes):
    # Until its lease is over it counts as the one that has the goal.
    name = robot(*SLOW, short_lease=True)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    nodes.end(name)
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    nodes.start(name, *FAST)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert len(events(nodes, name, "goal")) == 1


def test_an_adapter_that_is_killed_sends_no_goal_twice(desk, robot, adapter, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    adapter.kill()
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    adapter.start()
    desk.wait_for_step(f"go-{name}", "reached", 6)
    assert len(events(nodes, name, "goal asked")) == 1


def test_a_cone_is_placed_though_the_adapter_was_started_again_on_the_way(desk, robot, adapter, nodes):
    name = robot(*SLOW, able="cones")
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0, cone=True)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    adapter.kill()
    adapter.start()
    (cone,) = wait_until(lambda: events(nodes, name, "cone"), 20)
    assert (cone["x"], cone["y"]) == pytest.approx((24.0, 8.0))
    desk.wait_for_step(f"go-{name}", "reached", 10)


def test_a_goal_that_ended_while_the_adapter_was_away_is_over(desk, robot, adapter, nodes):
    near, far = robot(*SLOW), robot(*SLOW)
    desk.send(f"go-{near}", near, "SetPosEnd", x=22.0, y=8.0)
    desk.send(f"go-{far}", far, "SetPosEnd", x=24.0, y=8.0)
    for name in (near, far):
        desk.wait_for_step(f"go-{name}", "acknowledged")
    adapter.kill()
    desk.until(lambda: desk.robots[near]["state"] == "lost", 20)
    wait_until(lambda: events(nodes, near, "goal ended"), 20)
    adapter.start()
    desk.wait_for_step(f"go-{near}", "reached", 10)
    desk.wait_for_step(f"go-{far}", "reached", 10)


def test_a_goal_that_the_robot_gave_up_while_the_adapter_was_away_has_failed(desk, robot, adapter, nodes):
    name = robot(*SLOW, "--odd", "gives-up")
    desk.send(f"go-{name}", name, "SetPosEnd", x=90.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    adapter.kill()
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    wait_until(lambda: events(nodes, name, "goal ended"), 20)
    adapter.start()
    desk.wait_for_step(f"go-{name}", "failed", 10)
    assert "the robot gave up while this link was away" in steps(desk, f"go-{name}")[-1]["reason"]


def test_a_node_that_started_anew_while_the_adapter_was_away_is_sent_again(desk, robot, adapter, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    adapter.kill()
    nodes.end(name)
    nodes.start(name, *FAST)
    adapter.start()
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert len(events(nodes, name, "goal asked")) == 1


def test_a_gateway_that_is_killed_loses_no_command_and_repeats_none(bridge, desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=23.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged")
    bridge.kill_gateway()
    bridge.start_gateway()
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_step(f"go-{name}", "reached", 6)
    assert len(events(nodes, name, "goal asked")) == 1


@pytest.mark.skipif(not CutNetwork.is_possible(), reason="a network of its own takes root")
def test_a_network_that_was_cut_loses_nothing_and_does_nothing_twice(bridge, nodes, desk, tmp_path):
    driving, stopped, ordered = (f"robot{next(NUMBERS)}" for _ in range(3))
    network, domain = CutNetwork(), nodes.other_domain
    file = tmp_path / "cut.toml"
    more = f'interfaces = ["{network.interface}"]'
    file.write_text(
        SETTINGS.format(
            address=bridge.address, domain=domain, distribution=nodes.distribution, resolution=COARSE
        ).replace('range = "localhost"', f'range = "subnet"\n{more}'),
        encoding="utf-8",
    )
    with Processes(tmp_path / "logs") as processes:
        ros2_link(processes, file).start()
        try:
            for name in (driving, stopped, ordered):
                nodes.start(name, *SLOW, domain=domain, network=network.namespace)
            desk.wait_for_robots(driving, stopped, ordered, seconds=BUSY * 10)
            outlast_a_cut(desk, nodes, network.cut, network.mend, driving, stopped, ordered)
        finally:
            network.close()
            for name in (driving, stopped, ordered):
                nodes.end(name)


def test_the_shortest_settings_of_the_guide_show_a_robot_and_send_it(bridge, nodes, desk, tmp_path, guide):
    # What differs from one network to the next is said besides: the gateway's port, and the domain.
    text = guide("shortest").replace("domain = 0 ", f'range = "localhost"\ndomain = {nodes.other_domain}')
    file = tmp_path / "shortest.toml"
    file.write_text(f'[gateway]\nurl = "{bridge.address}/link"\n{text}', encoding="utf-8")
    name = f"robot{next(NUMBERS)}"
    with Processes(tmp_path / "logs") as processes:
        ros2_link(processes, file).start()
        nodes.start(name, *FAST, domain=nodes.other_domain)
        desk.wait_for_robots(name)
        desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
        desk.wait_for_step(f"go-{name}", "reached", 10)
        nodes.end(name)


def test_a_hostile_node_is_named_and_the_robots_go_on(desk, robot, adapter, nodes):
    from robot_bridge.links.ros2.dds import DdsSettings, Participant, Quality
    from robot_bridge.links.ros2.interfaces import type_to_dds

    name = robot(*FAST)
    hostile = Participant(DdsSettings(nodes.domain, "localhost"))
    odometry, status = type_to_dds("nav_msgs/msg/Odometry"), type_to_dds("action_msgs/msg/GoalStatusArray")
    forged = hostile.writer("rt/hostile/odom", odometry, Quality(reliable=False))
    poison = hostile.writer(f"rt/{name}/navigate_to_pose/_action/status", status, Quality(latched=True))
    text = type_to_dds("std_msgs/msg/String")
    other = [hostile.writer(f"rt/{one}/odom", text, Quality(reliable=False)) for one in (name, "textual")]
    lies = (b"\0\1\0\0" + b"\xff" * 64, b"\0\1\0\0" + bytes(2**20), bytes(8))

    def is_named():
        # Nobody waits for who is only just being met: it is said again and again.
        assert other, "who is not kept is gone"
        for data in lies:
            forged.write(data)
            poison.write(data)
        said = adapter.output()
        return (
            all(f"/{one}/odom has type std_msgs" in said for one in (name, "textual"))
            and "robot hostile: /hostile/odom: it is no nav_msgs/msg/Odometry" in said
            and f"robot {name}: the server of NavigateToPose" in said
        )

    wait_until(is_named)
    desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "reached", 10)
    assert "hostile" not in desk.robots and "textual" not in desk.robots


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("domain = 400", "ros2.domain is 400; give ROS_DOMAIN_ID"),
        ('distribution = "melodic"', "ros2.distribution = 'melodic': give one of foxy"),
        ('topics = { position = "/odom" }', "ros2.topics.position = '/odom': write '{robot}'"),
        ('topics = { odom = "/odom" }', "ros2.topics.odom is not a setting"),
        ('topics = { speed_info = "/{robot}/speed_info" }', "name its mask, too, as topics.speed_mask"),
        ("image_every_s = 0.1", "ros2.image_every_s = 0.1: give seconds from 1 to 86400"),
        ("largest_image_bytes = 9", "ros2.largest_image_bytes = 9: give bytes from 1024"),
        ("largest_image_bytes = 8_000_001", "ros2.largest_image_bytes = 8000001: give bytes from 1024"),
        ('path_actions = ["Teleport"]', "ros2.path_actions[0]: Invalid enum value 'Teleport'"),
        ('robots = ["agv-1"]', "ros2.topics.position: '/agv-1/odom' is no full name of a topic"),
    ],
)
def test_settings_that_cannot_be_used_name_file_and_key(tmp_path, lines, words):
    from robot_bridge.links.base.errors import LinkError
    from robot_bridge.links.ros2.adapter import load

    file = tmp_path / "nav2.toml"
    file.write_text(f"[ros2]\n{lines}\n", encoding="utf-8")
    with pytest.raises(LinkError) as caught:
        load(file)
    assert words in str(caught.value) and str(file) in str(caught.value)
