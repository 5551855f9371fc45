"""Real rclpy robots behind a real rosbridge server, as operators see them; each of the programs is killed."""

from __future__ import annotations

import asyncio
import itertools
import json

import pytest
from websockets.sync.client import connect

from robot_bridge.core.reconnection import ClientCredentials
from robot_bridge.links.rosbridge.connection import RosbridgeConnection, Subscription
from robot_bridge.links.rosbridge.settings import Server
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.cut_line import CutLine, outlast_a_cut
from tests.support.bridge.link_process import LinkProcess
from tests.support.patience import BUSY
from tests.support.processes import Processes
from tests.support.robots.ros_nodes import abort_before_the_goal, events

SETTINGS = """
[gateway]
url = "{address}/link"

[rosbridge]
url = "{url}"
distribution = "{distribution}"
map_resolution_m = 2.0
{more}

[rosbridge.topics]
stop = "/{{robot}}/stop"
place_cone = "/{{robot}}/place_cone"
map = "/{{robot}}/map"
get_map = "/{{robot}}/get_map"
keepout_mask = "/{{robot}}/keepout_mask"
keepout_info = "/{{robot}}/keepout_info"
"""
NUMBERS = itertools.count(1)
SLOW, FAST = ("--speed", "0.5"), ("--speed", "10")
CANCELED = 5
"""The status that a ROS action gives a goal that was canceled."""


def rosbridge_link(processes, file):
    """An adapter with memory that a hostile peer would soon use up."""
    return LinkProcess(processes, "rosbridge", file, 2_000_000_000)


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site, nodes):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture(scope="module")
def settings(bridge, nodes, server):
    """The settings of a link to the server; ``settings(url)`` of one to another."""

    def text(url=server.url, more=""):
        return SETTINGS.format(address=bridge.address, url=url, distribution=nodes.distribution, more=more)

    return text


@pytest.fixture(scope="module")
def adapter(settings, tmp_path_factory):
    folder = tmp_path_factory.mktemp("links")
    file = folder / "far.toml"
    file.write_text(settings())
    with Processes(folder / "logs") as processes:
        adapter = rosbridge_link(processes, file)
        adapter.start()
        yield adapter
        assert "Traceback" not in adapter.output(), adapter.output()


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

    def start(*options, seen=True, able="targets"):
        name = f"distant{next(NUMBERS)}"
        nodes.start(name, *options)
        started.append(name)
        if seen:
            desk.wait_for_robots(name, seconds=BUSY * 10)
            desk.wait_for_abilities(name, able)
        return name

    yield start
    for name in started:
        nodes.end(name)


def reason(desk, command):
    reports = desk.ask("get_commands", {})["commands"]
    (report,) = [one for one in reports if one["command"] == command]
    return report["steps"][-1]["reason"]


def test_a_cone_target_is_driven_reached_and_placed(desk, robot, nodes):
    name = robot(*FAST, able="cones")
    assert desk.robots[name]["x"] == pytest.approx(20.0)
    desk.until(lambda: desk.robots[name].get("battery") == 0.75, 20)
    desk.send(f"go-{name}", name, "SetPosEnd", x=40.0, y=8.0, cone=True)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    (cone,) = wait_until(lambda: events(nodes, name, "cone"))
    assert (cone["x"], cone["y"]) == pytest.approx((40.0, 8.0))
    (told,) = wait_until(lambda: events(nodes, name, "map"), 30)[:1]
    assert (told["columns"], told["rows"], told["frame"]) == (100, 80, "map")


def test_masks_come_latched_and_the_map_is_a_service_too(robot, nodes, server):
    name = robot()
    (mask,) = wait_until(lambda: events(nodes, name, "mask"), 40)
    assert (mask["columns"], mask["cells"]) == (100, {"road": 0, "excavation": 100})
    (info,) = wait_until(lambda: events(nodes, name, "filter"), 40)
    assert info["mask"] == f"/{name}/keepout_mask"
    with connect(server.url, max_size=None) as other:
        other.send(json.dumps({"op": "call_service", "id": "x", "service": f"/{name}/get_map", "args": {}}))
        answer = json.loads(other.recv(timeout=60))
    assert answer["values"]["map"]["info"]["width"] == 100 and answer["id"] == "x"


def test_a_route_is_followed_point_by_point(desk, robot, nodes):
    name = robot(*FAST, able="paths")
    points = [[20.0, 8.0], [30.0, 8.0], [30.0, 12.0]]
    desk.send(f"path-{name}", name, "SetPath", points=points)
    desk.wait_for_step(f"path-{name}", "reached", 8)
    (goal,) = events(nodes, name, "goal")
    assert goal["kind"] == "FollowPath" and goal["points"] == points


def test_a_newer_target_takes_the_place_of_the_one_before(desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    desk.send(f"on-{name}", name, "SetPosEnd", x=21.0, y=8.0)
    desk.wait_for_step(f"on-{name}", "reached", 8)
    assert len(events(nodes, name, "goal asked")) == 2


def test_an_abort_cancels_what_nav2_does(desk, robot, nodes):
    name = robot(*SLOW, "--odd", "deaf-stop")
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "acknowledged")
    desk.wait_for_step(f"go-{name}", "aborted")
    assert events(nodes, name, "cancel asked") and events(nodes, name, "goal ended")[0]["status"] == CANCELED


def test_an_abort_calls_the_stop_service_and_says_speed_0(desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    wait_until(lambda: events(nodes, name, "led"), 30)
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "acknowledged")
    desk.wait_for_step(f"go-{name}", "aborted")
    assert events(nodes, name, "goal ended") and events(nodes, name, "stop")
    assert wait_until(lambda: events(nodes, name, "zero twist"))


def test_a_goal_that_is_taken_on_after_its_abort_is_stopped_too(desk, robot, nodes):
    name = robot(*SLOW, "--odd", "late-goals")
    abort_before_the_goal(desk, nodes, name)


def test_an_emergency_stop_stops_and_is_cleared(desk, robot, nodes):
    name = robot(*SLOW, "--odd", "deaf-stop")
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    desk.ask("emergency_stop", {"command": f"emergency-{name}"})
    desk.ask("emergency_stop", {"command": f"again-{name}"})
    try:
        desk.until(lambda: desk.emergency["in_force"] and name not in desk.emergency["waiting"], 10)
        assert events(nodes, name, "goal ended")[0]["status"] == CANCELED
    finally:
        desk.ask("clear_emergency_stop", {})
    desk.send(f"on-{name}", name, "SetPosEnd", x=desk.robots[name]["x"] + 0.5, y=8.0)
    desk.wait_for_step(f"on-{name}", "reached", 8)


def test_a_robot_that_will_not_stop_is_told_to_operators(desk, robot):
    name = robot(*SLOW, "--odd", "stubborn")
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "failed", 4)
    assert "was not confirmed within 5 s" in reason(desk, f"stop-{name}")


@pytest.mark.again("ros2/test_ros2_live.py, under the same name; of this wire test_rosbridge_goals.py")
@pytest.mark.parametrize(
    ("odd", "words"), [("rejects", "rejected the goal"), ("fails", "a test asked for it (error 9003)")]
)
def test_why_a_robot_does_not_drive_is_told(desk, robot, odd, words):
    name = robot("--odd", odd)
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "failed")
    assert words in reason(desk, f"go-{name}")


def test_a_robot_without_actions_drives_to_what_is_published(desk, robot, nodes):
    name = robot(*FAST, "--odd", "no-actions")
    # Its topics are found one by one.
    desk.until(lambda: "targets" in (desk.robots[name].get("abilities") or ""), 20)
    desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert events(nodes, name, "goal pose")[0]["points"] == [[25.0, 8.0]]


@pytest.mark.again("ros2/test_ros2_live.py::test_what_is_wrong_with_one_robot_is_named_and_the_others_go_on")
def test_positions_that_are_nan_are_named_and_the_others_go_on(desk, robot, adapter):
    name = robot("--odd", "nan", seen=False)
    wait_until(lambda: f"robot {name}: " in adapter.output() and "position.x is nan" in adapter.output(), 30)
    other = robot(*FAST)
    assert desk.robots[other]["state"] == "fresh" and name not in desk.robots


@pytest.mark.again("ros2/test_ros2_live.py, under the same name; of this wire test_rosbridge_goals.py")
def test_a_node_that_is_killed_and_started_anew_is_sent_again_what_is_open(desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    nodes.end(name)
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    nodes.start(name, *FAST)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert len(events(nodes, name, "goal")) == 1


def test_a_server_that_is_killed_and_started_again_restores_every_topic(desk, robot, server, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    server.kill()
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    server.start()
    desk.until(lambda: desk.robots[name]["state"] == "fresh", 30)
    desk.wait_for_step(f"go-{name}", "reached", 8)
    assert len(events(nodes, name, "goal asked")) == 1
    desk.send(f"on-{name}", name, "SetPosEnd", x=26.0, y=8.0)
    desk.wait_for_step(f"on-{name}", "reached", 8)
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "acknowledged")


def test_an_abort_without_the_server_is_told_and_comes_with_it(desk, robot, server, nodes):
    name = robot(*SLOW, "--odd", "deaf-stop")
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    server.kill()
    try:
        desk.send(f"stop-{name}", name, "Abort")
        desk.wait_for_step(f"stop-{name}", "failed", 5)
        assert server.url in reason(desk, f"stop-{name}")
        assert not events(nodes, name, "goal ended")
    finally:
        server.start()
    (ended,) = wait_until(lambda: events(nodes, name, "goal ended"), 30)
    assert ended["status"] == CANCELED


def test_an_adapter_that_is_killed_sends_no_goal_twice_and_says_what_became_of_it(
    desk, robot, adapter, nodes
):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=24.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    adapter.kill()
    desk.until(lambda: desk.robots[name]["state"] == "lost", 20)
    (ended,) = wait_until(lambda: events(nodes, name, "goal ended"))
    adapter.start()
    # This server cancels the goals of a client that leaves, but not always; others let them go on.
    if ended["status"] == CANCELED:
        desk.wait_for_step(f"go-{name}", "failed", 8)
        assert "canceled while rosbridge was away" in reason(desk, f"go-{name}")
    else:
        desk.wait_for_step(f"go-{name}", "reached", 8)
    assert len(events(nodes, name, "goal asked")) == 1
    desk.send(f"on-{name}", name, "SetPosEnd", x=desk.robots[name]["x"] + 0.5, y=8.0)
    desk.wait_for_step(f"on-{name}", "reached", 8)


def test_a_gateway_that_is_killed_loses_no_command_and_repeats_none(bridge, desk, robot, nodes):
    name = robot(*SLOW)
    desk.send(f"go-{name}", name, "SetPosEnd", x=23.0, y=8.0)
    desk.wait_for_step(f"go-{name}", "acknowledged", 5)
    bridge.kill_gateway()
    bridge.start_gateway()
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_step(f"go-{name}", "reached", 6)
    assert len(events(nodes, name, "goal asked")) == 1


LATE = pytest.param(False, id="bytes come late", marks=pytest.mark.again("bytes are lost"))


@pytest.mark.parametrize("reset", [LATE, pytest.param(True, id="bytes are lost")])
def test_a_network_that_was_cut_loses_nothing_and_does_nothing_twice(
    desk, nodes, start_server, settings, tmp_path, reset
):
    domain = nodes.other_domain
    names = [f"distant{next(NUMBERS)}" for _ in range(3)]
    line = CutLine(start_server(domain).port)
    file = tmp_path / "cut.toml"
    file.write_text(settings(line.address), encoding="utf-8")
    with Processes(tmp_path / "logs") as processes:
        rosbridge_link(processes, file).start()
        try:
            for name in names:
                nodes.start(name, *SLOW, domain=domain)
            desk.wait_for_robots(*names, seconds=BUSY * 10)
            outlast_a_cut(desk, nodes, line.cut, lambda: line.mend(reset=reset), *names)
        finally:
            line.close()
            for name in names:
                nodes.end(name)


async def test_more_than_the_server_takes_at_once_keeps_the_connection_and_all_of_it_arrives(server):
    connection = RosbridgeConnection(Server(server.url, ClientCredentials()))
    carrying = asyncio.create_task(connection.run())
    text, seen = Subscription("std_msgs/msg/String"), []
    try:
        async with asyncio.timeout(BUSY * 30):
            while connection.away is not None:
                await asyncio.sleep(0.05)
            heard = connection.subscribe("/crowd/said", text)
            connection.advertise("/crowd/said", text.type_name)

            async def until(last):
                while last not in seen:
                    connection.publish("/crowd/said", {"data": last})
                    await asyncio.sleep(0.1)
                    seen.extend(message["data"] for message in heard.drain())

            await until("begin")
            for n in range(400):
                connection.subscribe(f"/crowd{n}/said", text)
            # As many as an emergency stop has for hundreds of robots.
            for n in range(300):
                connection.publish("/crowd/said", {"data": f"{n}"}, urgent=True)
            await until("end")
        assert connection.session == 1 and connection.away is None
    finally:
        carrying.cancel()
        await asyncio.gather(carrying, return_exceptions=True)


def test_the_shortest_settings_of_the_guide_show_a_robot_and_send_it(
    bridge, nodes, start_server, desk, tmp_path, guide
):
    # What differs from one network to the next is said besides: the ports of gateway and server.
    domain = nodes.domain + 50
    text = guide("shortest").replace("ws://127.0.0.1:9090", start_server(domain).url)
    file = tmp_path / "shortest.toml"
    file.write_text(f'[gateway]\nurl = "{bridge.address}/link"\n{text}', encoding="utf-8")
    name = f"distant{next(NUMBERS)}"
    with Processes(tmp_path / "logs") as processes:
        rosbridge_link(processes, file).start()
        nodes.start(name, *FAST, domain=domain)
        desk.wait_for_robots(name)
        desk.send(f"go-{name}", name, "SetPosEnd", x=25.0, y=8.0)
        desk.wait_for_step(f"go-{name}", "reached", 10)
        nodes.end(name)
