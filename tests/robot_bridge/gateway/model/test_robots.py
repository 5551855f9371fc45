"""What is known of robots: revisions say what is new, late poses move nothing back, silence ages."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import NotReadyError
from robot_bridge.core.messages.positions import RobotReport
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.gateway.fleet.operator_updates import reports_of
from robot_bridge.gateway.model.robots import Robot, Robots


def pose(x, t=None, v=0.0):
    return SendPos(x, 0.0, 0.0, v, t=t)


@pytest.fixture
def robots() -> Robots:
    robots = Robots(stale_after=3.0, lost_after=10.0)
    robots.ready("r1", 7, "websocket", 100.0)
    return robots


def reports(robots: Robots, now: float, since: int = -1) -> list[RobotReport]:
    return reports_of(robots.changed(since), now, RobotReport)


def only(robots: Robots, now: float):
    (report,) = reports(robots, now)
    return report


def test_a_robot_that_never_said_ready_is_not_known(robots):
    with pytest.raises(NotReadyError, match="robot 'r2' has not said Ready"):
        robots.note_received("r2", "sql", 100.0)
    with pytest.raises(NotReadyError):
        robots.observe("r2", pose(1.0), "sql", 100.0)
    assert robots.names() == ["r1"]


def test_a_robot_without_a_pose_is_reported_without_one(robots):
    report = only(robots, 101.5)
    assert (report.x, report.v, report.age, report.link) == (None, None, 1.5, "websocket")


def test_the_same_magic_is_the_same_run_of_the_robot(robots):
    assert not robots.starts_anew("r1", 7)
    assert robots.starts_anew("r1", 8)
    assert not robots.starts_anew("r2", 8)
    robots.ready("r1", 8, "websocket", 101.0)
    assert not robots.starts_anew("r1", 8)
    assert robots.starts_anew("r1", 7)


def test_a_late_pose_never_moves_a_robot_back(robots):
    assert robots.observe("r1", pose(5.0, t=50.0), "websocket", 101.0) is True
    assert robots.observe("r1", pose(4.0, t=49.9), "websocket", 102.0) is False
    report = only(robots, 102.0)
    assert (report.x, report.device_time) == (5.0, 50.0)
    assert report.age == 0.0  # late as it was, the robot was heard


def test_a_pose_without_a_device_time_counts_as_it_comes(robots):
    robots.observe("r1", pose(5.0, t=50.0), "websocket", 101.0)
    assert robots.observe("r1", pose(6.0), "websocket", 102.0) is True
    assert only(robots, 102.0).x == 6.0


def test_a_robot_that_started_anew_may_count_its_time_from_nought(robots):
    robots.observe("r1", pose(5.0, t=5000.0), "websocket", 101.0)
    robots.ready("r1", 8, "websocket", 102.0)
    assert robots.observe("r1", pose(1.0, t=3.0), "websocket", 103.0) is True
    assert only(robots, 103.0).x == 1.0


def test_only_what_changed_has_a_newer_revision(robots):
    robots.ready("r2", 9, "sql", 100.0)
    seen = robots.revision
    assert reports(robots, 101.0, since=seen) == []
    robots.observe("r2", pose(1.0), "sql", 101.0)
    assert [report.robot for report in reports(robots, 101.0, since=seen)] == ["r2"]
    assert [report.robot for report in reports(robots, 101.0)] == ["r1", "r2"]


def test_ageing_touches_a_robot_once_for_each_state(robots):
    changes = []
    for now in (101.0, 102.9, 103.0, 105.0, 109.9, 110.0, 500.0):
        seen = robots.revision
        robots.age(now)
        changes += [(now, report.state.value) for report in reports(robots, now, since=seen)]
    assert changes == [(103.0, "stale"), (110.0, "lost")]


def test_a_lost_robot_that_speaks_is_fresh_at_once(robots):
    robots.age(200.0)
    robots.note_received("r1", "websocket", 200.5)
    assert only(robots, 200.5).state is RobotState.FRESH


@pytest.mark.parametrize("end", ["stopped", "closed"])
def test_a_robot_that_ended_in_order_goes_offline(robots, end):
    if end == "stopped":
        robots.note_received("r1", "websocket", 101.0, stopped=True)
    else:
        robots.closed("r1")
    robots.age(150.0)
    assert only(robots, 150.0).state is RobotState.OFFLINE


def test_a_stopped_robot_that_says_more_and_falls_silent_is_lost_until_it_ends_in_order(robots):
    robots.note_received("r1", "websocket", 101.0, stopped=True)
    robots.note_received("r1", "websocket", 102.0)
    assert only(robots, 102.0).stopped is True
    robots.age(120.0)
    assert only(robots, 120.0).state is RobotState.LOST
    robots.observe("r1", pose(1.0), "websocket", 130.0)
    robots.age(140.0)
    assert only(robots, 140.0).state is RobotState.LOST
    robots.closed("r1")
    robots.age(140.0)
    assert only(robots, 140.0).state is RobotState.OFFLINE


def test_standing_positions_leave_a_stopped_robot_stopped_and_driving_ones_do_not(robots):
    robots.note_received("r1", "websocket", 101.0, stopped=True)
    robots.observe("r1", pose(1.0, v=0.01), "websocket", 102.0)
    assert only(robots, 102.0).stopped is True
    robots.observe("r1", pose(1.1, v=0.5), "websocket", 103.0)
    assert only(robots, 103.0).stopped is False


def test_the_task_of_a_robot_is_a_change_once(robots):
    seen = robots.revision
    robots.assign("r1", "c-1")
    assert [report.command for report in reports(robots, 101.0, since=seen)] == ["c-1"]
    seen = robots.revision
    robots.assign("r1", "c-1")
    robots.assign("unknown", "c-1")
    assert robots.revision == seen


def test_a_robot_of_an_earlier_gateway_is_as_old_as_its_last_message():
    robots = Robots()
    robots.restore(Robot("r1", 7, "sql", received_at=100.0, pose=pose(1.0), pose_at=100.0), now=105.0)
    robots.restore(Robot("r2", 7, "sql", received_at=100.0, ended_in_order=True), now=105.0)
    assert [(r.robot, r.state.value, r.age) for r in reports(robots, 105.0)] == [
        ("r1", "stale", 5.0),
        ("r2", "offline", 5.0),
    ]


def test_a_silent_robot_ages_also_when_the_gateways_clock_is_set_back(robots):
    robots.age(50.0)
    robots.age(60.0)
    assert (only(robots, 60.0).state, only(robots, 60.0).age) == (RobotState.LOST, 10.0)


def test_the_latency_is_told_with_the_next_change(robots):
    seen = robots.revision
    robots.measured("r1", 0.01234)
    robots.measured("nobody", 1.0)
    assert reports(robots, 101.0, since=seen) == []
    robots.observe("r1", pose(1.0), "websocket", 102.0)
    assert only(robots, 102.0).latency == 0.0123


def test_the_three_clocks_of_a_pose_are_told_apart(robots):
    robots.observe("r1", SendPos(1.0, 2.0, 0.0, 0.0, t=7.0, fix_t=6.5), "websocket", 102.0)
    robots.note_received("r1", "websocket", 104.0)
    report = only(robots, 105.0)
    assert (report.device_time, report.fix_time, report.pose_age, report.age) == (7.0, 6.5, 3.0, 1.0)
