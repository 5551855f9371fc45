"""The adapter around its connection: commands without it, the file of goals, the order of what is said."""

from __future__ import annotations

import asyncio
import json

import pytest

from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.links.base.adapter import Command
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.ros.effects import CancelGoals, RosAction
from robot_bridge.links.ros.goals import goal_id
from robot_bridge.links.ros.messages import TWIST
from robot_bridge.links.ros.settings import TopicSettings
from robot_bridge.links.rosbridge.adapter import RosbridgeActions, RosbridgeAdapter
from robot_bridge.links.rosbridge.connection import MOST_ANSWERS_WAITING, MOST_WAITING, RosbridgeConnection
from robot_bridge.links.rosbridge.decoding import ServiceCall
from robot_bridge.links.rosbridge.goals import ActionGoals, GoalBook
from robot_bridge.links.rosbridge.graph import Graph
from robot_bridge.links.rosbridge.settings import RosbridgeSettings, Server
from robot_bridge.protocol.credentials import ClientCredentials

SERVER = Server("ws://127.0.0.1:9", ClientCredentials())


@pytest.fixture
def adapter(tmp_path):
    return RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "far.goals")


@pytest.fixture
def connection():
    """A connection of which nothing is sent yet."""
    connection = RosbridgeConnection(SERVER)
    connection.away = None
    return connection


def waiting(connection):
    frames = [*connection._commands, *connection._others]
    return [json.loads(one if isinstance(one, bytes) else one()) for one in frames]


async def test_a_command_without_the_server_is_refused_with_the_reason(adapter):
    with pytest.raises(CommandRefusedError, match="not connected yet"):
        await adapter.command(Command("r1", 7, SetPosEnd(1.0, 2.0)))


def test_the_next_process_reads_which_goals_are_open(adapter, tmp_path):
    adapter._book("r1").add(RosAction.TO_POSE, goal_id(7), frozenset([bytes(16)])).real = bytes(range(16))
    adapter._book("r2").add(RosAction.TO_POSE, goal_id(8), frozenset()).is_over = True
    adapter.note_goals()
    again = RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "far.goals")
    assert again._book("r1").find(goal_id(7)).real == bytes(range(16))
    assert again._book("r2").entries == []


@pytest.mark.parametrize("text", ["", "[]", "{", '{"r1": 7}', '{"r1": [{}]}', '{"r1": [{"action": 1}]}'])
def test_a_file_of_goals_that_is_none_is_left_out(tmp_path, text, caplog):
    (tmp_path / "far.goals").write_text(text, encoding="utf-8")
    again = RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "far.goals")
    assert again._book("r1").entries == [] and "is left out" in caplog.text


def test_a_file_of_goals_that_cannot_be_written_is_told_and_ends_nothing(tmp_path):
    adapter = RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "nowhere" / "far.goals")
    adapter.note_goals()
    assert "far.goals cannot be written" in adapter._notes.fault
    (tmp_path / "nowhere").mkdir()
    adapter.note_goals()
    assert adapter._notes.fault is None


def test_a_cancel_comes_before_maps_and_never_before_the_goal_that_it_cancels(connection):
    connection.publish("/r1/map", {"data": [0]}, latched=True)
    connection.send_goal("goal:r1", "/r1/navigate_to_pose", "nav2_msgs/action/NavigateToPose", {}, print)
    connection.call("/r1/navigate_to_pose/_action/cancel_goal", {}, print, urgent=True)
    connection.publish("/r1/cmd_vel", {}, urgent=True)
    said = [one["op"] for one in waiting(connection)]
    assert said == ["send_action_goal", "call_service", "publish", "publish"]
    assert waiting(connection)[-1]["topic"] == "/r1/map"


def test_all_that_stops_a_robot_comes_before_the_maps_of_others(adapter, connection):
    settings = RosbridgeSettings(topics=TopicSettings(stop="/{robot}/stop"))
    goals = ActionGoals("r1", connection, GoalBook(), adapter)
    acting = RosbridgeActions("r1", settings, connection, None, goals)
    acting.connect(
        Graph(
            topics={"/r1/cmd_vel": TWIST},
            services=frozenset({"/r1/stop"}),
            actions=frozenset({"/r1/navigate_to_pose"}),
            listeners={"/r1/cmd_vel": 1},
        )
    )
    connection._commands.clear()
    connection._others.clear()
    connection.publish("/r9/map", {"data": [0]}, latched=True)
    acting.cancel(CancelGoals(RosAction.TO_POSE))
    acting.publish_zero()
    acting.call("stop")
    said = [one.get("topic") or one["service"] for one in waiting(connection)]
    assert said == ["/r1/navigate_to_pose/_action/cancel_goal", "/r1/cmd_vel", "/r1/stop", "/r9/map"]


def test_nothing_that_stops_a_robot_is_thrown_away_for_room(connection):
    for number in range(MOST_WAITING + 10):
        connection.publish("/r1/map", {"n": number})
    connection.call("/r1/stop", {}, print, urgent=True)
    said = waiting(connection)
    assert len(said) == MOST_WAITING + 1 and said[0]["service"] == "/r1/stop"


def test_who_asks_for_the_map_without_end_is_not_answered_without_end(connection):
    connection.serve("/r1/get_map", "nav_msgs/srv/GetMap", {"map": {}})
    for number in range(1000):
        connection._receive(ServiceCall("/r1/get_map", str(number)))
        connection._receive(ServiceCall("/r9/get_map", str(number)))
    answers = [one for one in waiting(connection) if one["op"] == "service_response"]
    assert len(answers) == MOST_ANSWERS_WAITING - 1
    assert {one["service"] for one in answers} == {"/r1/get_map"}


async def test_what_is_said_without_a_connection_is_not_said_later():
    connection = RosbridgeConnection(SERVER)
    connection.publish("/r1/cmd_vel", {}, urgent=True)
    connection.call("/r1/stop", {}, print, urgent=True)
    await asyncio.sleep(0)
    assert waiting(connection) == []
