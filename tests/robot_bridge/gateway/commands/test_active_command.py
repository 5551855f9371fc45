"""What one command tells of itself, and what the commands of one robot do to each other."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.base import to_json
from robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from robot_bridge.core.messages.robots import SetPath, SetPosIni
from robot_bridge.gateway.commands.active_command import (
    ActiveCommand,
    CommandOrder,
    Recall,
    because,
    create_command,
    ended_by,
    given_up_by,
    recalled,
    superseded,
)
from robot_bridge.gateway.model.arrival import PathArrival, TargetArrival
from tests.robot_bridge.gateway.commands.command_makers import (
    ABORT,
    ACKNOWLEDGED,
    DELIVERED,
    EMERGENCY,
    PATH,
    QUEUED,
    TARGET,
    command,
    last,
    pose,
)

BEGIN = SetPosIni(1.0, 2.0)
LOOP = SetPath([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 0.0)])


def test_what_is_drafted_is_queued_by_its_operator_and_has_no_row_yet():
    order = CommandOrder("c-1", "r1", TARGET, "Ada", "cones", expires_in=30.0)
    step = CommandStep(QUEUED, 100.0, "Ada", "cones")
    report = CommandReport("c-1", "r1", "SetPosEnd", to_json(TARGET), "Ada", QUEUED, [step])
    assert create_command(order, 100.0) == ActiveCommand(
        report, 0, TARGET, expires_at=130.0, written_at=100.0
    )
    assert create_command(CommandOrder("c-1", "r1", TARGET, "Ada"), 100.0).expires_at is None


@pytest.mark.parametrize(
    ("message", "kinds"),
    [
        (TARGET, (True, False, False)),
        (PATH, (True, False, False)),
        (BEGIN, (False, False, False)),
        (ABORT, (False, True, False)),
        (EMERGENCY, (False, True, True)),
    ],
)
def test_a_command_drives_or_ends_what_is_driven_and_an_emergency_is_one_of_these(message, kinds):
    made = command(1, message)
    assert (made.is_motion, made.is_abort, made.is_emergency) == kinds


@pytest.mark.parametrize(
    ("states", "is_on_its_way"),
    [((), True), ((DELIVERED,), True), ((ACKNOWLEDGED,), False), ((CommandState.REACHED,), False)],
)
def test_a_command_is_on_its_way_until_the_robot_says_that_it_took_it_on(states, is_on_its_way):
    assert command(1, TARGET, *states).is_on_its_way is is_on_its_way


def test_a_command_was_taken_on_when_the_robot_said_so_last():
    assert command(1).acknowledged_at == 100.0
    taken = command(1, TARGET, DELIVERED, ACKNOWLEDGED)
    assert taken.acknowledged_at == 102.0
    assert taken.noted(110.0, "r1", "acknowledged again").acknowledged_at == 110.0
    assert taken.step(CommandState.REACHED, 120.0, "gateway").acknowledged_at == 102.0


def test_only_a_path_that_is_judged_has_a_line_and_metres():
    for made in (command(1, PATH), command(1).judged(0.2)):
        assert (made.line, made.driven) == (None, None)
    judged = command(1, PATH).judged(0.2)
    assert judged.driven == 0.0
    assert judged.line.length == 10.0


def test_a_note_keeps_the_state_and_ends_the_judging():
    noted = command(1, PATH, ACKNOWLEDGED).judged(0.2).noted(105.0, "gateway", "sent once more")
    assert last(noted) == ("acknowledged", 105.0, "gateway", "sent once more")
    assert noted.report.state is ACKNOWLEDGED and noted.arrival is None


def test_a_command_is_judged_by_where_its_robot_was_and_whether_it_was_seen():
    assert command(1, handed=pose()).judged(0.2).arrival == TargetArrival(TARGET, 0.2)
    # Seen standing at the end of its loop: it has driven that only if it was out of sight, and has moved.
    begun = command(1, LOOP, handed=pose(), out_of_sight=True).judged(0.2)
    assert begun.arrival.deviation(pose()) is None
    come = command(1, LOOP, handed=pose(5.0, -8.0), out_of_sight=True).judged(0.2)
    come.arrival.deviation(pose())
    assert come.arrival.idle_deviation(pose()) == 0.0
    assert (
        command(1, LOOP, handed=pose(), out_of_sight=True).judged(0.2).arrival.idle_deviation(pose()) is None
    )
    seen = command(1, LOOP, handed=pose(5.0, -8.0)).judged(0.2)
    seen.arrival.deviation(pose())
    assert seen.arrival.idle_deviation(pose()) is None


@pytest.mark.parametrize(("handed", "deviation"), [(pose(), None), (None, 0.0)])
def test_who_was_out_of_sight_is_looked_for_from_where_it_was_seen_before(handed, deviation):
    lanes = SetPath([(0.0, 0.0), (50.0, 0.0), (50.0, 3.0), (0.0, 3.0)])
    judged = command(1, lanes, handed=handed, out_of_sight=True).judged(0.2)
    # Three metres beside its beginning, at its end.
    assert judged.arrival.deviation(pose(0.0, 3.0)) == deviation


def test_who_was_out_of_sight_is_judged_so_when_it_takes_the_path_on_and_afterwards():
    made = command(1, PATH)
    assert made.out_of_sight is False
    made.lose_sight()
    assert made.out_of_sight is True
    for was_seen in (True, False):
        driving = command(1, LOOP).judged(0.2)
        for x in (0.0, 3.0):
            driving.arrival.deviation(pose(x, v=1.0))
        if not was_seen:
            driving.lose_sight()
        driving.arrival.deviation(pose())
        assert driving.arrival.idle_deviation(pose()) == (None if was_seen else 0.0)
    target = command(1).judged(0.2)
    target.lose_sight()
    assert target.arrival == TargetArrival(TARGET, 0.2)


def test_what_was_fetched_before_it_could_be_recalled_was_delivered_then():
    queued = command(1)
    ended = queued.step(CommandState.ABORTED, 105.0, "Ada", "smoke").noted(107.0, "r1", "too late")
    fetched = Recall(queued, ended).fetched
    assert last(fetched) == ("delivered", 107.0, "gateway", None)
    assert fetched.sa_id == 1


# --- what they do to each other -----------------------------------------------------------------------------


def order(message, reason=None):
    return CommandOrder("new", "r1", message, "Bob", reason)


MINE = [
    command(1, TARGET, DELIVERED, ACKNOWLEDGED),
    command(2, PATH),
    command(3, BEGIN),
    command(4, ABORT),
    command(5, EMERGENCY),
]


@pytest.mark.parametrize(
    ("message", "replaced"),
    [
        (TARGET, ["c-1", "c-2"]),
        (PATH, ["c-1", "c-2"]),
        (BEGIN, ["c-3"]),
        (ABORT, ["c-4"]),
        (EMERGENCY, ["c-4", "c-5"]),
    ],
)
def test_each_kind_takes_the_place_of_its_own_and_an_abort_of_no_emergency_stop(message, replaced):
    ends = superseded(order(message), MINE, 200.0)
    assert [end.report.command for end in ends] == replaced
    assert {last(end) for end in ends} == {("superseded", 200.0, "Bob", "by command new")}


def test_an_abort_recalls_the_tasks_that_were_not_fetched():
    assert recalled(order(TARGET), MINE, 200.0) == []
    for message in (ABORT, EMERGENCY):
        (recall,) = recalled(order(message, "smoke"), MINE, 200.0)
        assert recall.queued is MINE[1]
        assert last(recall.ended) == (
            "aborted",
            200.0,
            "Bob",
            "before the robot acknowledged it: smoke",
        )
    (recall,) = recalled(order(ABORT), MINE, 200.0)
    assert last(recall.ended)[3] == "before the robot acknowledged it"


def test_an_abort_ends_the_tasks_that_came_before_it_and_nothing_else():
    tasks = [command(1, TARGET, ACKNOWLEDGED), command(4, PATH), command(9), command(2, BEGIN)]
    (end,) = ended_by(command(4, ABORT, reason="smoke"), tasks, 200.0, "it stood")
    assert (end.report.command, last(end)) == ("c-1", ("aborted", 200.0, "Ada", "it stood: smoke"))
    assert ended_by(command(4), tasks, 200.0, "it stood") == []


def test_a_task_is_given_up_by_the_newest_abort_that_was_taken_on_after_it():
    task = command(4, TARGET, ACKNOWLEDGED)
    aborts = [
        command(3, ABORT, ACKNOWLEDGED),
        command(6, ABORT, ACKNOWLEDGED),
        command(7, ABORT, ACKNOWLEDGED),
        command(8, ABORT, DELIVERED),
        command(9, TARGET, ACKNOWLEDGED),
    ]
    assert given_up_by(task, [task, *aborts]) is aborts[2]
    assert given_up_by(task, [task, aborts[0], *aborts[3:]]) is None
    assert given_up_by(command(6, ABORT, ACKNOWLEDGED), aborts) is None
    assert given_up_by(task, [command(4, ABORT, ACKNOWLEDGED)]) is None


@pytest.mark.parametrize(
    ("reason", "text"), [("smoke", "it stood: smoke"), (None, "it stood"), ("", "it stood")]
)
def test_a_reason_follows_what_happened(reason, text):
    assert because("it stood", reason) == text


def test_a_command_step_keeps_how_far_off_and_where_it_was():
    reached = command(1).step(CommandState.REACHED, 105.0, "gateway", "late", 0.1, (1.0, 2.0, 3.0))
    assert last(reached) == ("reached", 105.0, "gateway", "late")
    assert (reached.report.deviation, reached.report.stood) == (0.1, (1.0, 2.0, 3.0))
    assert isinstance(command(1, PATH).judged(0.2).arrival, PathArrival)
