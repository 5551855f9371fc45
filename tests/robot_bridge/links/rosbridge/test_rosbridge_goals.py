"""Which goal on the robot is whose, over connections and processes that come and go."""

from __future__ import annotations

import base64
from collections import deque

import pytest

from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.links.ros.effects import Abilities, Answered, CancelGoals, Idle, RosAction, SendGoal
from robot_bridge.links.ros.goals import GoalStatus, goal_id
from robot_bridge.links.ros.tasks import Tasks
from robot_bridge.links.rosbridge import goals as goals_module
from robot_bridge.links.rosbridge.connection import Inbox
from robot_bridge.links.rosbridge.decoding import ActionFeedback, ActionResult
from robot_bridge.links.rosbridge.goals import LEFT, LOST, SETTLED_AFTER, ActionGoals, GoalStore
from robot_bridge.links.rosbridge.graph import Graph

TOPIC = "/r1/navigate_to_pose"
STATUS = f"{TOPIC}/_action/status"
NAV2 = Abilities(actions=frozenset({RosAction.TO_POSE}))
TARGET = SetPosEnd(5.0, 6.0)
OTHERS, REAL = bytes(16), bytes(range(16))
LATER = SETTLED_AFTER + 1.0


class Connection:
    """Keeps what is sent, and has as many sessions as the test says."""

    def __init__(self):
        self.away, self.session = None, 1
        self.inbox, self.sent, self.canceled, self.renewed = Inbox(), deque(), [], []

    def subscribe(self, topic, wanted):
        assert topic == STATUS
        return self.inbox

    def renew(self, topic):
        self.renewed.append(topic)

    def send_goal(self, id, action, type_name, goal, answered):
        self.sent.append((id, goal, answered))

    def cancel_goal(self, id, action):
        self.canceled.append(id)


class Robot:
    """One robot's goals and tasks; time is what the test says."""

    def __init__(self, monkeypatch, store=None):
        self.now, self.noted = 100.0, 0
        monkeypatch.setattr(goals_module.time, "monotonic", lambda: self.now)
        self.connection, self.tasks = Connection(), Tasks(cones=False)
        self.store = store or GoalStore()
        self.goals = ActionGoals("r1", self.connection, self.store, self)
        self.goals.poll(self.tasks, self.now, self.fault)
        self.see()

    def note_goals(self):
        self.noted += 1

    def fault(self, what, text):
        raise AssertionError(text)

    def see(self, *, actions=(TOPIC,), publishers=1):
        graph = Graph(self.connection.session, actions=frozenset(actions), publishers={STATUS: publishers})
        self.goals.meet(RosAction.TO_POSE, TOPIC, graph)

    def hear(self, statuses):
        told = [
            {"goal_info": {"goal_id": {"uuid": base64.b64encode(real).decode()}}, "status": int(status)}
            for real, status in statuses.items()
        ]
        self.connection.inbox.waiting.append({"status_list": told})
        return self.poll()

    def poll(self):
        effects = self.goals.poll(self.tasks, self.now, self.fault)
        return effects + self.tasks.step(NAV2, self.now)

    def order(self, message, *, again=False):
        for effect in self.tasks.order(message, TARGET, NAV2, self.now, again=again):
            assert isinstance(effect, SendGoal)
            self.goals.send(effect, {"pose": {}})
        return self.poll()

    def reconnect(self):
        self.connection.session += 1
        self.poll()
        self.see()


@pytest.fixture
def robot(monkeypatch):
    return Robot(monkeypatch)


def test_the_goal_that_is_new_after_ours_was_sent_is_ours(robot):
    robot.hear({OTHERS: GoalStatus.EXECUTING})
    robot.order(7)
    assert len(robot.connection.sent) == 1
    assert robot.hear({OTHERS: GoalStatus.ABORTED}) == []
    assert robot.hear({OTHERS: GoalStatus.ABORTED, REAL: GoalStatus.EXECUTING}) == [Answered(7)]
    assert robot.hear({REAL: GoalStatus.SUCCEEDED}) == [Idle()]


def test_a_goal_waits_until_those_are_known_that_are_there(robot):
    robot.order(7)
    assert not robot.connection.sent
    robot.hear({OTHERS: GoalStatus.EXECUTING})
    assert len(robot.connection.sent) == 1


def test_a_goal_waits_no_longer_than_a_latched_message_takes(robot):
    robot.now += LATER
    robot.order(7)
    assert len(robot.connection.sent) == 1


def test_a_goal_that_waits_is_not_sent_after_a_stop(robot):
    robot.order(7)
    assert robot.goals.cancel(CancelGoals(RosAction.TO_POSE)) == {}
    robot.hear({OTHERS: GoalStatus.EXECUTING})
    assert not robot.connection.sent


def test_one_goal_is_canceled_by_the_id_that_it_has_on_the_robot(robot):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    asked = robot.goals.cancel(CancelGoals(RosAction.TO_POSE, goal_id(7)))
    assert asked == {"goal_info": {"goal_id": {"uuid": list(REAL)}}}


def test_a_goal_that_shows_up_after_it_was_given_up_is_canceled(robot):
    robot.hear({})
    robot.order(7)
    robot.now += 6.0
    cancel, refused = robot.poll()
    assert "did not answer" in refused.refusal
    assert robot.goals.cancel(cancel) is None and robot.connection.canceled == [robot.connection.sent[0][0]]
    assert CancelGoals(RosAction.TO_POSE, goal_id(7)) in robot.hear({REAL: GoalStatus.EXECUTING})


def test_a_goal_that_never_showed_up_does_not_claim_the_next_one(robot):
    robot.hear({})
    robot.order(7)
    robot.now += 6.0
    cancel, _ = robot.poll()
    robot.goals.cancel(cancel)
    robot.order(8)
    assert robot.hear({REAL: GoalStatus.EXECUTING}) == [Answered(8)]


def test_a_goal_goes_on_over_a_new_connection(robot):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    robot.reconnect()
    assert robot.connection.renewed == [STATUS]
    assert robot.hear({REAL: GoalStatus.EXECUTING}) == []
    robot.now += LATER
    assert robot.poll() == []
    assert robot.hear({REAL: GoalStatus.SUCCEEDED}) == [Idle()]


def test_a_goal_that_is_on_no_list_after_a_reconnect_has_failed(robot):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    robot.reconnect()
    assert robot.hear({OTHERS: GoalStatus.EXECUTING}) == []
    robot.now += LATER
    refused, idle = robot.poll()
    assert (refused.message, idle) == (7, Idle()) and LOST in refused.refusal


def test_a_goal_that_was_canceled_while_away_has_failed_with_that_reason(robot):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    robot.reconnect()
    refused, _ = robot.hear({REAL: GoalStatus.CANCELED})
    assert LEFT in refused.refusal


def test_the_next_process_finds_the_goal_and_does_not_send_it_again(robot, monkeypatch):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    assert robot.noted >= 2
    after = Robot(monkeypatch, GoalStore.from_json(robot.store.to_json()))
    after.order(7, again=True)
    after.hear({OTHERS: GoalStatus.ABORTED, REAL: GoalStatus.EXECUTING})
    after.now += LATER
    after.poll()
    assert not after.connection.sent and after.tasks.goal == goal_id(7)
    assert after.hear({REAL: GoalStatus.SUCCEEDED}) == [Idle()]


def test_the_next_process_finds_a_goal_whose_id_nobody_had_seen_yet(robot, monkeypatch):
    robot.hear({OTHERS: GoalStatus.EXECUTING})
    robot.order(7)
    after = Robot(monkeypatch, GoalStore.from_json(robot.store.to_json()))
    after.order(7, again=True)
    assert Answered(7) in after.hear({OTHERS: GoalStatus.ABORTED, REAL: GoalStatus.EXECUTING})
    assert not after.connection.sent


def test_the_next_process_says_what_became_of_a_goal_that_is_over(robot, monkeypatch):
    robot.hear({})
    robot.order(7)
    robot.hear({REAL: GoalStatus.EXECUTING})
    noted = robot.store.to_json()
    assert Robot(monkeypatch, GoalStore.from_json(noted)).hear({REAL: GoalStatus.SUCCEEDED}) == [Idle()]
    canceled = Robot(monkeypatch, GoalStore.from_json(noted))
    assert canceled.hear({REAL: GoalStatus.CANCELED}) == [Answered(7, LEFT), Idle()]
    assert canceled.store.to_json() == []
    gone = Robot(monkeypatch, GoalStore.from_json(noted))
    gone.now += LATER
    assert gone.poll() == [Answered(7, LOST), Idle()]


def test_a_server_that_went_and_came_again_is_another_one(robot):
    before = robot.goals.server
    robot.hear({})
    robot.order(7)
    robot.see(actions=())
    assert robot.goals.server is None
    robot.see()
    assert robot.goals.server not in (None, before) and robot.store.entries == []


def test_a_second_publisher_of_a_status_is_a_server_that_was_started_anew(robot):
    before = robot.goals.server
    robot.see(publishers=2)
    assert robot.goals.server != before
    after = robot.goals.server
    robot.see(publishers=1)
    assert robot.goals.server == after


def test_a_server_that_is_not_found_yet_over_a_new_connection_is_the_same_one(robot):
    before = robot.goals.server
    robot.connection.session += 1
    robot.see(actions=())
    robot.see()
    assert robot.goals.server == before


def test_feedback_and_result_stand_in_for_a_status_that_cannot_be_read(robot):
    robot.now += LATER
    robot.order(7)
    _, _, answered = robot.connection.sent[0]
    answered(ActionFeedback("x", {"distance_remaining": 2.5}))
    assert robot.poll() == [Answered(7)] and robot.goals.feedback == "navigating: 2.5 m left"
    answered(ActionResult("x", {"error_code": 0, "error_msg": ""}, 4, True))
    assert robot.poll() == [Idle()]


def test_a_goal_that_was_not_taken_on_is_refused(robot):
    robot.hear({})
    robot.order(7)
    robot.connection.sent[0][2](ActionResult("x", "goal was rejected", 6, False))
    robot.poll()
    robot.now += 1.0
    assert Answered(7, "the robot's server of NavigateToPose rejected the goal") in robot.poll()


@pytest.mark.parametrize("rows", [[{}], [{"action": "Fly", "goal": "", "real": None, "before": []}], 7])
def test_a_book_that_is_none_is_refused(rows):
    with pytest.raises((ValueError, KeyError, TypeError)):
        GoalStore.from_json(rows)
