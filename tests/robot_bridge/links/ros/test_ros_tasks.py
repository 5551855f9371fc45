"""The life of a robot's tasks, and its stops, decided without I/O."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.robots import SetPath, SetPosEnd
from robot_bridge.links.ros.effects import (
    Abilities,
    Answered,
    CallCone,
    CallStop,
    CancelGoals,
    Idle,
    PublishHere,
    PublishTask,
    RosAction,
    SendGoal,
    StopEnded,
    ZeroTwist,
)
from robot_bridge.links.ros.goals import GoalStatus, goal_id, message_of
from robot_bridge.links.ros.tasks import MOST_GIVEN_UP, Tasks

NAV2 = Abilities(actions=frozenset({RosAction.TO_POSE, RosAction.FOLLOW_PATH}), velocity=True)
TOPICS = Abilities(goal_topic=True, path_topic=True, velocity=True)
TARGET = SetPosEnd(5.0, 6.0)
PATH = SetPath([(0.0, 0.0), (5.0, 0.0)])


@pytest.fixture
def tasks():
    return Tasks(cones=True)


def statuses(tasks, status, message=7, action=RosAction.TO_POSE, now=0.0, cone=False):
    return tasks.statuses_came(action, {goal_id(message, cone=cone): status}, now)


def test_the_id_of_a_goal_names_its_message():
    assert message_of(goal_id(7)) == 7 and message_of(goal_id(7, 12)) == 7
    assert message_of(bytes(16)) is None


def test_a_target_is_a_goal_taken_on_when_its_status_says_so(tasks):
    assert tasks.order(7, TARGET, NAV2, 0.0) == [SendGoal(RosAction.TO_POSE, goal_id(7), TARGET, 7)]
    tasks.goal_answered(RosAction.TO_POSE, True, 0.1)  # maybe to another client
    assert tasks.step(NAV2, 0.2) == []
    assert statuses(tasks, GoalStatus.EXECUTING) == [Answered(7)]
    assert statuses(tasks, GoalStatus.EXECUTING) == []
    assert statuses(tasks, GoalStatus.SUCCEEDED) == [Idle()]
    assert not tasks.is_busy


def test_a_path_goes_to_who_follows_paths(tasks):
    (sent,) = tasks.order(7, PATH, NAV2, 0.0)
    assert sent.action is RosAction.FOLLOW_PATH
    through = Tasks(cones=False)
    (sent,) = through.order(7, PATH, Abilities(frozenset({RosAction.THROUGH_POSES})), 0.0)
    assert sent.action is RosAction.THROUGH_POSES


EVERY = Abilities(frozenset(RosAction))


@pytest.mark.parametrize("wanted", [RosAction.FOLLOW_PATH, RosAction.THROUGH_POSES, RosAction.WAYPOINTS])
def test_a_path_goes_to_the_action_that_the_settings_name_first(wanted):
    tasks = Tasks(cones=False, path_actions=[wanted, RosAction.FOLLOW_PATH])
    (sent,) = tasks.order(7, PATH, EVERY, 0.0)
    assert sent.action is wanted


def test_an_action_that_the_settings_leave_out_drives_no_path():
    tasks = Tasks(cones=False, path_actions=[RosAction.WAYPOINTS])
    (answer,) = tasks.order(7, PATH, NAV2, 0.0)
    assert "FollowWaypoints that the settings allow" in answer.refusal


def test_an_action_of_another_distribution_is_sent_nothing_and_is_canceled_all_the_same():
    able = Abilities(
        frozenset({RosAction.TO_POSE, RosAction.FOLLOW_PATH}), frozenset({RosAction.FOLLOW_PATH})
    )
    tasks = Tasks(cones=False)
    (answer,) = tasks.order(7, PATH, able, 0.0)
    assert "nobody on the robot's side follows paths" in answer.refusal
    assert CancelGoals(RosAction.FOLLOW_PATH) in tasks.abort(able, 0.0)


@pytest.fixture
def waypoints():
    tasks = Tasks(cones=False)
    (sent,) = tasks.order(7, PATH, Abilities(frozenset({RosAction.WAYPOINTS})), 0.0)
    assert sent.action is RosAction.WAYPOINTS
    return tasks


def test_waypoints_are_driven_when_the_result_names_none_that_was_missed(waypoints):
    assert statuses(waypoints, GoalStatus.SUCCEEDED, action=RosAction.WAYPOINTS) == [Answered(7)]
    waypoints.result_came(RosAction.WAYPOINTS, 4, 0, "", [])
    assert waypoints.step(EVERY, 0.1) == [Idle()]


@pytest.mark.parametrize("result_first", [True, False])
def test_waypoints_that_were_missed_are_a_failure_that_names_them(waypoints, result_first):
    def result():
        waypoints.result_came(RosAction.WAYPOINTS, 4, 0, "", [0, 3])

    if result_first:
        result()
    effects = statuses(waypoints, GoalStatus.SUCCEEDED, action=RosAction.WAYPOINTS)
    if not result_first:
        result()
    effects += waypoints.step(EVERY, 0.1)
    refusal = Answered(7, "the robot left out points of the path: 1, 4")
    assert effects == [Answered(7), refusal, Idle()]


def test_waypoints_without_a_result_are_driven_after_a_while(waypoints):
    assert statuses(waypoints, GoalStatus.SUCCEEDED, action=RosAction.WAYPOINTS) == [Answered(7)]
    assert waypoints.step(EVERY, 1.9) == []
    assert waypoints.step(EVERY, 2.1) == [Idle()]


def test_a_rejected_goal_is_refused_and_canceled_for_safety(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    tasks.goal_answered(RosAction.TO_POSE, False, 0.1)
    assert tasks.step(NAV2, 0.2) == []
    cancel, refused = tasks.step(NAV2, 0.5)
    assert cancel == CancelGoals(RosAction.TO_POSE, goal_id(7))
    assert refused == Answered(7, "the robot's server of NavigateToPose rejected the goal")


def test_a_rejection_of_another_clients_goal_refuses_nothing(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    tasks.goal_answered(RosAction.TO_POSE, False, 0.1)
    assert statuses(tasks, GoalStatus.ACCEPTED, now=0.2) == [Answered(7)]
    assert tasks.step(NAV2, 0.5) == []


def test_a_server_that_does_not_answer_is_named(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    assert tasks.step(NAV2, 4.9) == []
    assert "did not answer within 5 s" in tasks.step(NAV2, 5.0)[1].refusal


def test_a_goal_that_fails_says_why(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.EXECUTING)
    statuses(tasks, GoalStatus.ABORTED, now=3.0)
    assert tasks.step(NAV2, 3.1) == []
    tasks.result_came(RosAction.TO_POSE, GoalStatus.ABORTED, 9003, "blocked by a gate")
    assert tasks.step(NAV2, 3.2) == [
        Answered(7, "the robot gave up: blocked by a gate (error 9003)"),
        Idle(),
    ]


def test_a_goal_that_somebody_else_cancels_fails(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.CANCELED, now=1.0)
    (failed, _) = tasks.step(NAV2, 3.0)
    assert failed.refusal == "it was canceled on the robot's side"


def test_a_new_target_takes_the_place_of_the_one_before(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.EXECUTING)
    assert tasks.order(8, TARGET, NAV2, 1.0) == [SendGoal(RosAction.TO_POSE, goal_id(8), TARGET, 8)]
    both = {goal_id(7): GoalStatus.EXECUTING, goal_id(8): GoalStatus.ACCEPTED}
    assert tasks.statuses_came(RosAction.TO_POSE, both, 1.1) == [
        Answered(8),
        CancelGoals(RosAction.TO_POSE, goal_id(7)),
    ]
    assert statuses(tasks, GoalStatus.ABORTED, message=7) == []


def test_another_action_begins_when_the_one_before_has_ended(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.EXECUTING)
    assert tasks.order(8, PATH, NAV2, 1.0) == [CancelGoals(RosAction.TO_POSE, goal_id(7))]
    assert tasks.step(NAV2, 1.1) == []
    statuses(tasks, GoalStatus.CANCELED)
    assert tasks.step(NAV2, 1.2) == [SendGoal(RosAction.FOLLOW_PATH, goal_id(8), PATH, 8)]


def test_a_goal_that_an_earlier_process_sent_is_not_sent_again(tasks):
    statuses(tasks, GoalStatus.EXECUTING)
    assert tasks.order(7, TARGET, NAV2, 1.0, again=True) == [Answered(7)]
    assert statuses(tasks, GoalStatus.SUCCEEDED) == [Idle()]


def test_a_goal_that_ended_while_nobody_led_the_robot_is_not_driven_again(tasks):
    statuses(tasks, GoalStatus.SUCCEEDED)
    assert tasks.order(7, TARGET, NAV2, 1.0, again=True) == [Answered(7), Idle()]


def test_a_goal_of_an_earlier_process_that_fails_is_told(tasks):
    statuses(tasks, GoalStatus.EXECUTING)
    statuses(tasks, GoalStatus.ABORTED, now=1.0)
    assert tasks.step(NAV2, 3.0)[0] == Answered(7, "the robot gave up")


def test_an_id_that_another_database_gave_is_made_another_goal(tasks):
    statuses(tasks, GoalStatus.SUCCEEDED)
    (sent,) = tasks.order(7, TARGET, NAV2, 1.0)
    assert sent.goal_id != goal_id(7) and message_of(sent.goal_id) == 7


def test_a_robot_without_actions_is_told_on_topics(tasks):
    assert tasks.order(7, TARGET, TOPICS, 0.0) == [PublishTask(TARGET), Answered(7)]
    assert tasks.order(8, PATH, TOPICS, 0.0) == [PublishTask(PATH), Answered(8)]


def test_a_robot_to_which_nobody_listens_is_refused(tasks):
    assert "no server of NavigateToPose" in tasks.order(7, TARGET, Abilities(), 0.0)[0].refusal
    assert "no server of FollowPath" in tasks.order(7, PATH, Abilities(), 0.0)[0].refusal


def test_a_cone_is_placed_where_the_goal_ends(tasks):
    able = Abilities(NAV2.actions, cone_service=True)
    tasks.order(7, SetPosEnd(5.0, 6.0, cone=True), able, 0.0)
    statuses(tasks, GoalStatus.EXECUTING, cone=True)
    assert statuses(tasks, GoalStatus.SUCCEEDED, cone=True) == [CallCone()]
    assert statuses(tasks, GoalStatus.SUCCEEDED, cone=True) == []
    assert tasks.cone_answered(True, "") == [Idle()]


def test_a_cone_is_placed_where_a_goal_of_an_earlier_process_ends(tasks):
    goal = goal_id(7, cone=True)
    assert message_of(goal) == 7
    tasks.statuses_came(RosAction.TO_POSE, {goal: GoalStatus.EXECUTING}, 0.0)
    assert tasks.statuses_came(RosAction.TO_POSE, {goal: GoalStatus.SUCCEEDED}, 1.0) == [CallCone()]
    assert tasks.cone_answered(True, "") == [Idle()]


def test_a_cone_of_which_nobody_knows_is_told(tasks):
    tasks.statuses_came(RosAction.TO_POSE, {goal_id(7, cone=True): GoalStatus.SUCCEEDED}, 0.0)
    told, idle = tasks.step(NAV2, 2.0)
    assert (told.message, idle) == (7, Idle()) and "whether its cone was handled" in told.refusal


def test_a_cone_that_is_not_placed_fails_the_task(tasks):
    able = Abilities(NAV2.actions, cone_service=True)
    tasks.order(7, SetPosEnd(5.0, 6.0, cone=True), able, 0.0)
    statuses(tasks, GoalStatus.SUCCEEDED, cone=True)
    (failed,) = tasks.cone_answered(False, "empty")
    assert failed.refusal == "it stands there, and its cone service said 'empty'"


def test_a_cone_for_a_robot_that_places_none_is_refused():
    cone = SetPosEnd(5.0, 6.0, cone=True)
    assert "name no cone service" in Tasks(cones=False).order(7, cone, NAV2, 0.0)[0].refusal


CANCELED = 0


def test_a_stop_cancels_everything_and_says_speed_0_until_it_is_answered(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.EXECUTING)
    first = tasks.abort(NAV2, 1.0)
    assert first == [ZeroTwist(), CancelGoals(RosAction.FOLLOW_PATH), CancelGoals(RosAction.TO_POSE)]
    assert tasks.step(NAV2, 1.05) == []
    assert tasks.step(NAV2, 1.1) == [ZeroTwist()]
    assert CancelGoals(RosAction.TO_POSE) in tasks.step(NAV2, 1.6)
    tasks.cancel_answered(RosAction.FOLLOW_PATH, CANCELED)
    tasks.cancel_answered(RosAction.TO_POSE, CANCELED)
    assert StopEnded() not in tasks.step(NAV2, 1.7)
    statuses(tasks, GoalStatus.CANCELED)
    assert tasks.step(NAV2, 1.8) == [StopEnded()]
    assert tasks.step(NAV2, 9.0) == []


def test_a_stop_that_is_refused_says_who_did_not_answer_and_goes_on(tasks):
    statuses(tasks, GoalStatus.EXECUTING)
    tasks.abort(NAV2, 0.0)
    tasks.cancel_answered(RosAction.FOLLOW_PATH, CANCELED)
    tasks.cancel_answered(RosAction.TO_POSE, 1)
    ended = [one for one in tasks.step(NAV2, 5.0) if isinstance(one, StopEnded)]
    assert "its server of NavigateToPose does not answer" in ended[0].refusal
    assert CancelGoals(RosAction.TO_POSE) in tasks.step(NAV2, 7.5)


def test_nothing_is_begun_behind_a_stop_that_nobody_confirmed(tasks):
    tasks.abort(NAV2, 0.0)
    tasks.step(NAV2, 5.0)
    (refused,) = [one for one in tasks.order(8, TARGET, NAV2, 6.0) if isinstance(one, Answered)]
    assert "was not confirmed" in refused.refusal


def test_what_comes_behind_a_stop_waits_for_its_end(tasks):
    tasks.abort(NAV2, 0.0)
    assert not any(isinstance(one, SendGoal) for one in tasks.order(8, TARGET, NAV2, 0.1))
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    assert tasks.step(NAV2, 0.2) == [StopEnded()]
    assert tasks.step(NAV2, 0.3) == [SendGoal(RosAction.TO_POSE, goal_id(8), TARGET, 8)]


def test_a_stop_service_has_to_confirm(tasks):
    able = Abilities(stop_service=True)
    assert tasks.abort(able, 0.0) == [CallStop()]
    tasks.stop_answered(False, "brake stuck")
    ended = [one for one in tasks.step(able, 5.0) if isinstance(one, StopEnded)]
    assert "it said 'brake stuck'" in ended[0].refusal
    tasks.abort(able, 6.0)
    # Who has started anew may drive on all the same: only the service's word ends the stop.
    tasks.forget()
    assert tasks.is_busy
    assert CallStop() in tasks.step(able, 6.6)
    tasks.stop_answered(True, "")
    assert tasks.step(able, 6.7) == [StopEnded()]


def test_a_robot_on_topics_has_stopped_when_it_is_seen_to_stand(tasks):
    first = tasks.abort(TOPICS, 0.0)
    assert first == [ZeroTwist(), PublishHere()]
    for speed in (1.0, 0.0, 0.01):
        assert StopEnded() not in tasks.step(TOPICS, 0.05)
        tasks.seen(speed)
    assert tasks.step(TOPICS, 0.2) == [StopEnded()]


def test_a_robot_to_which_nobody_listens_is_stopped_by_nobody(tasks):
    tasks.abort(Abilities(), 0.0)
    (ended,) = tasks.step(Abilities(), 5.0)
    assert "nobody listens there to any stop" in ended.refusal


def test_a_stop_finds_what_was_waiting(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    statuses(tasks, GoalStatus.EXECUTING)
    tasks.order(8, PATH, NAV2, 1.0)
    assert Answered(8, "it was aborted before it was begun") in tasks.abort(NAV2, 1.1)


def test_a_goal_that_is_taken_on_behind_the_stop_that_ended_it_is_stopped_too(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    tasks.abort(NAV2, 0.01)
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    assert tasks.step(NAV2, 0.1) == [StopEnded()]
    # The server has dealt with the cancel first, and with the goal now.
    statuses(tasks, GoalStatus.EXECUTING, now=0.2)
    assert CancelGoals(RosAction.TO_POSE) in tasks.step(NAV2, 0.3)
    (said,) = [one for one in tasks.step(NAV2, 5.4) if isinstance(one, StopEnded)]
    assert "Stop it on site" in said.refusal


def test_a_goal_that_is_taken_on_late_does_not_stop_what_the_robot_has_been_sent_to_since(tasks):
    tasks.order(7, PATH, NAV2, 0.0)
    tasks.abort(NAV2, 0.01)
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    tasks.step(NAV2, 0.1)
    tasks.order(8, TARGET, NAV2, 0.2)
    statuses(tasks, GoalStatus.EXECUTING, message=8)
    statuses(tasks, GoalStatus.EXECUTING, action=RosAction.FOLLOW_PATH)
    cancel = [CancelGoals(RosAction.FOLLOW_PATH, goal_id(7))]
    assert tasks.step(NAV2, 0.6) == cancel
    assert tasks.step(NAV2, 0.7) == []
    assert tasks.step(NAV2, 1.2) == cancel
    assert tasks.goal == goal_id(8)


def test_a_goal_that_nobody_answered_in_time_is_canceled_when_it_is_taken_on(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    assert CancelGoals(RosAction.TO_POSE, goal_id(7)) in tasks.step(NAV2, 5.0)
    statuses(tasks, GoalStatus.EXECUTING, now=6.0)
    assert tasks.step(NAV2, 6.1) == [CancelGoals(RosAction.TO_POSE, goal_id(7))]
    assert tasks.goal is None


def test_a_target_waits_for_a_doubled_cancel_that_would_hit_it(tasks):
    tasks.abort(NAV2, 0.0)
    tasks.step(NAV2, 0.6)
    tasks.order(8, TARGET, NAV2, 0.7)
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    assert tasks.step(NAV2, 0.8) == [StopEnded()]
    assert tasks.step(NAV2, 0.9) == []
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    assert tasks.step(NAV2, 1.0) == [SendGoal(RosAction.TO_POSE, goal_id(8), TARGET, 8)]


def test_a_target_does_not_wait_for_an_answer_that_was_lost(tasks):
    tasks.abort(NAV2, 0.0)
    tasks.step(NAV2, 0.6)
    for action in NAV2.actions:
        tasks.cancel_answered(action, CANCELED)
    tasks.step(NAV2, 0.8)
    assert tasks.order(8, TARGET, NAV2, 0.9) == []
    assert tasks.step(NAV2, 2.7) == [SendGoal(RosAction.TO_POSE, goal_id(8), TARGET, 8)]


def test_a_stop_that_comes_twice_at_once_asks_once(tasks):
    first = tasks.abort(NAV2, 0.0)
    assert CancelGoals(RosAction.TO_POSE) in first and tasks.abort(NAV2, 0.03) == []


def test_only_the_newest_goals_that_were_given_up_are_remembered(tasks):
    for message in range(MOST_GIVEN_UP + 1):
        tasks.order(message, TARGET, NAV2, 0.0)
        tasks.abort(NAV2, 0.0)
        for action in NAV2.actions:
            tasks.cancel_answered(action, CANCELED)
        tasks.step(NAV2, 0.0)
    assert len(tasks._given_up) == MOST_GIVEN_UP and goal_id(0) not in tasks._given_up


def test_a_goal_of_an_earlier_process_that_has_ended_is_told_once(tasks):
    former = {goal_id(6): GoalStatus.SUCCEEDED, goal_id(7): GoalStatus.ABORTED}
    assert tasks.statuses_came(RosAction.TO_POSE, former, 0.0) == [] and tasks.step(NAV2, 1.0) == []
    told, idle = tasks.step(NAV2, 2.0)
    assert (told.message, idle) == (7, Idle()) and "the robot gave up" in told.refusal
    assert tasks.statuses_came(RosAction.TO_POSE, former, 3.0) == [] and tasks.step(NAV2, 6.0) == []


def test_of_an_ended_goal_nothing_is_told_while_another_server_drives_a_newer_one(tasks):
    statuses(tasks, GoalStatus.CANCELED, message=7)
    statuses(tasks, GoalStatus.EXECUTING, message=8, action=RosAction.FOLLOW_PATH, now=1.9)
    assert tasks.step(NAV2, 2.0) == [] and tasks.goal == goal_id(8)


@pytest.fixture
def patient():
    """Tasks of a robot whose server was just lost from sight, with an order that waits for it."""
    tasks = Tasks(cones=False, hold_s=10.0)
    assert tasks.order(7, TARGET, Abilities(), 0.0) == [] and tasks.is_only_held
    return tasks


def test_a_target_waits_for_its_server_and_is_sent_once(patient):
    assert patient.step(Abilities(), 9.0) == []
    patient.forget()  # its server is there again, and is taken for another one
    assert patient.step(NAV2, 9.5) == [SendGoal(RosAction.TO_POSE, goal_id(7), TARGET, 7)]
    assert patient.step(NAV2, 9.6) == [] and not patient.is_only_held


def test_a_target_that_waits_is_refused_in_the_end(patient):
    (answer,) = patient.step(Abilities(), 10.0)
    assert "nobody on the robot's side drives to targets" in answer.refusal and "10 s" in answer.refusal
    assert patient.step(NAV2, 10.5) == [] and not patient.is_busy


def test_a_target_that_waited_while_the_link_stood_still_is_not_sent(patient):
    (answer,) = patient.step(NAV2, 70.0)
    assert "the link stood still" in answer.refusal and not patient.is_busy


def test_a_stop_ends_a_target_that_waits_and_goes_out_at_once(patient):
    able = Abilities(velocity=True)
    effects = patient.abort(able, 1.0)
    assert Answered(7, "it was aborted before it was begun") in effects and ZeroTwist() in effects
    assert not any(isinstance(one, SendGoal) for one in patient.step(NAV2, 1.1))


def test_a_target_that_waits_is_not_sent_once_nobody_waits_for_it(patient):
    assert patient.withdraw(7, 0.5) == []
    assert patient.step(NAV2, 1.0) == []


def test_a_goal_that_is_taken_on_when_nobody_waits_for_it_any_more_is_stopped(tasks):
    tasks.order(7, TARGET, NAV2, 0.0)
    assert tasks.withdraw(7, 1.0) == [CancelGoals(RosAction.TO_POSE, goal_id(7))]
    assert statuses(tasks, GoalStatus.EXECUTING, now=2.0) == []
    assert CancelGoals(RosAction.TO_POSE) in tasks.step(NAV2, 2.0) + tasks.step(NAV2, 2.1)


def test_a_newer_target_takes_the_place_of_one_that_waits(patient):
    refused, sent = patient.order(8, TARGET, NAV2, 1.0)
    assert refused == Answered(7, "another task came before it was begun") and sent.message == 8
