"""The adapter around its connection: commands without it, the file of goals, the order of what is said."""

from __future__ import annotations

import asyncio
import json
import random

import pytest
from websockets.asyncio.server import serve

from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.core.reconnection import ClientCredentials
from robot_bridge.links.base.adapter import Command
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.ros.effects import CancelGoals, RosAction
from robot_bridge.links.ros.goals import goal_id
from robot_bridge.links.ros.messages import TWIST
from robot_bridge.links.ros.settings import TopicSettings
from robot_bridge.links.rosbridge.adapter import MOST_ANSWERS, RosbridgeActions, RosbridgeAdapter
from robot_bridge.links.rosbridge.connection import (
    LARGEST_SENT,
    MOST_ANSWERS_WAITING,
    MOST_CALLS,
    MOST_COMMANDS_UNREAD,
    MOST_FAULTS,
    MOST_UNREAD,
    MOST_WAITING,
    TOGETHER,
    RosbridgeConnection,
    Subscription,
    encode,
)
from robot_bridge.links.rosbridge.decoding import ServiceCall, ServiceResponse
from robot_bridge.links.rosbridge.goals import MOST_BEFORE, MOST_ENTRIES, ActionGoals, GoalStore
from robot_bridge.links.rosbridge.graph import Graph
from robot_bridge.links.rosbridge.settings import RosbridgeSettings, Server
from tests.support.bridge.cut_line import CutLine
from tests.support.patience import until

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
    adapter._store("r1").add(RosAction.TO_POSE, goal_id(7), frozenset([bytes(16)])).real = bytes(range(16))
    adapter._store("r2").add(RosAction.TO_POSE, goal_id(8), frozenset()).is_over = True
    adapter.note_goals()
    again = RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "far.goals")
    assert again._store("r1").find(goal_id(7)).real == bytes(range(16))
    assert again._store("r2").entries == []


@pytest.mark.parametrize("text", ["", "[]", "{", '{"r1": 7}', '{"r1": [{}]}', '{"r1": [{"action": 1}]}'])
def test_a_file_of_goals_that_is_none_is_left_out(tmp_path, text, caplog):
    (tmp_path / "far.goals").write_text(text, encoding="utf-8")
    again = RosbridgeAdapter(RosbridgeSettings(), SERVER, tmp_path / "far.goals")
    assert again._store("r1").entries == [] and "is left out" in caplog.text


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
    goals = ActionGoals("r1", connection, GoalStore(), adapter)
    acting = RosbridgeActions("r1", settings, connection, connection, None, goals)
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


def test_a_topic_is_read_and_written_though_there_is_no_room(connection):
    for number in range(MOST_WAITING):
        connection.publish("/r1/map", {"n": number})
    connection.subscribe("/r1/odom", Subscription("nav_msgs/msg/Odometry"))
    connection.advertise("/r1/cmd_vel", TWIST)
    assert [one["op"] for one in waiting(connection)[-2:]] == ["subscribe", "advertise"]


def test_an_answer_that_never_comes_is_not_waited_for_without_end(connection):
    came = []
    for _ in range(MOST_CALLS + 1):
        connection.call("/r1/stop", {}, came.append)
    ids = [one["id"] for one in waiting(connection)]
    connection._receive(ServiceResponse(ids[0]))
    assert came == []
    connection._receive(ServiceResponse(ids[1]))
    assert len(came) == 1


def test_of_what_is_wrong_with_frames_the_newest_is_told(connection):
    for number in range(MOST_FAULTS + 1):
        connection._record_fault(f"/r{number}/odom: nonsense")
    assert len(connection.faults) == MOST_FAULTS and "/r0/odom: nonsense" not in connection.faults
    connection._faults["old"] = (-1000.0, "of long ago")
    assert "of long ago" not in connection.faults


def test_a_server_that_has_dealt_with_nothing_is_sent_no_more_and_stops_a_little_longer(connection):
    for number in range(MOST_UNREAD + 10):
        connection.publish("/r1/map", {"n": number})

    def sent():
        count = 0
        while connection._next() is not None:
            connection._sent, count = connection._sent + 1, count + 1
        return count

    assert sent() == MOST_UNREAD
    for _ in range(MOST_COMMANDS_UNREAD):
        connection.call("/r1/stop", {}, print, urgent=True)
    assert sent() == MOST_COMMANDS_UNREAD - MOST_UNREAD
    # Who does not say how far it is is sent what stops robots all the same.
    connection._is_answering = False
    assert sent() == MOST_UNREAD + 10


def test_a_message_that_no_server_takes_is_refused():
    with pytest.raises(ValueError, match="10000000 are the most"):
        encode("std_msgs/msg/String", {"data": "x" * LARGEST_SENT})


def test_of_goals_the_newest_are_remembered():
    store = GoalStore()
    before = frozenset(n.to_bytes(16, "big") for n in range(MOST_BEFORE + 1))
    for message in range(MOST_ENTRIES + 1):
        entry = store.add(RosAction.TO_POSE, goal_id(message), before)
    assert len(entry.before) == MOST_BEFORE
    assert [one.goal for one in store.entries] == [goal_id(n) for n in range(1, MOST_ENTRIES + 1)]
    assert len(GoalStore.from_json(store.to_json() * (MOST_ENTRIES + 1)).entries) == MOST_ENTRIES


def test_of_answers_that_nobody_has_read_the_newest_are_kept(adapter, connection):
    goals = ActionGoals("r1", connection, GoalStore(), adapter)
    acting = RosbridgeActions("r1", RosbridgeSettings(), connection, connection, None, goals)
    for number in range(MOST_ANSWERS + 1):
        acting._keep("stop", None, ServiceResponse(str(number)))
        goals._keep(None, ServiceResponse(str(number)))
    assert len(acting._answers) == len(goals._answers) == MOST_ANSWERS
    assert acting._answers[0][2].id == goals._answers[0][1].id == "1"


class Frames:
    """A connection over which frames have come, and that has ended behind them."""

    def __init__(self, *frames):
        self._frames = frames

    async def __aiter__(self):
        for frame in self._frames:
            yield frame

    async def send(self, frame, text):
        """Nobody is there."""


async def test_what_was_asked_and_came_over_one_connection_counts_nothing_over_the_next(connection):
    inbox = connection.subscribe("/r1/odom", Subscription("nav_msgs/msg/Odometry"))
    inbox.waiting.append({"old": 1})
    came = []
    connection.call("/r1/stop", {}, came.append)
    (asked,) = [one["id"] for one in waiting(connection) if one["op"] == "call_service"]
    await connection._carry(Frames(json.dumps({"op": "service_response", "id": asked})))
    assert came == [] and inbox.drain() == []


async def test_a_flood_of_frames_lets_others_have_their_turn(connection):
    turns = []

    async def other():
        while True:
            turns.append(1)
            await asyncio.sleep(0)

    running = asyncio.create_task(other())
    await connection._read(Frames(*["{}"] * (TOGETHER * 3)))
    running.cancel()
    assert len(turns) >= 3


async def test_what_is_said_without_a_connection_is_not_said_later():
    connection = RosbridgeConnection(SERVER)
    connection.publish("/r1/cmd_vel", {}, urgent=True)
    connection.call("/r1/stop", {}, print, urgent=True)
    await asyncio.sleep(0)
    assert waiting(connection) == []


async def test_a_stop_does_not_wait_for_a_map_that_is_on_a_slow_line(tmp_path):
    heard = []

    async def hear(connection):
        async for frame in connection:
            heard.append(json.loads(frame)["op"])

    async with serve(hear, "127.0.0.1", 0, max_size=None) as server:
        line = CutLine(server.sockets[0].getsockname()[1])
        here = Server(line.address, ClientCredentials())
        adapter = RosbridgeAdapter(RosbridgeSettings(), here, tmp_path / "far.goals")
        connection, maps = connections = adapter._connection, adapter._maps
        running = [asyncio.create_task(one.run()) for one in connections]
        await until(lambda: connection.away is None and maps.away is None)
        settings = RosbridgeSettings(topics=TopicSettings(stop="/{robot}/stop", map="/{robot}/map"))
        goals = ActionGoals("r1", connection, GoalStore(), adapter)
        acting = RosbridgeActions("r1", settings, connection, maps, None, goals)
        acting.connect(Graph(services=frozenset({"/r1/stop"})))
        # It compresses badly, and takes a minute.
        line.slow_down(1_000, 0.1)
        acting.publish_latched("map", json.dumps(random.randbytes(500_000).hex()).encode())
        await until(lambda: not maps._others)
        acting.call("stop")
        await until(lambda: "call_service" in heard)
        assert "publish" not in heard
        line.close()
        for one in running:
            one.cancel()
        await asyncio.gather(*running, return_exceptions=True)
