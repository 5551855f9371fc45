"""The audit finds what it is there to find: each story is right but for one thing."""

from __future__ import annotations

import copy
import hashlib
from collections import Counter
from types import SimpleNamespace

import pytest

from tests.support.faults.audit import Deaths, Stored, judged
from tests.support.faults.cluster_yard import (
    Stop,
    done_though_refused,
    moved_while_stopped,
    taken_up_again,
)
from tests.support.faults.desk import Ledger
from tests.support.faults.yard import GATEWAY_KILLED, Death, Fault

TARGET, STOP = "sq01-000001", "sq01-000001-abort"
IMAGE = b"an image"


def step(state, at, reason=None):
    return SimpleNamespace(state=state, at=at, reason=reason)


def line(what, at, **more):
    return {"what": what, "at": at, "robot": "sq01", "life": 1, **more}


@pytest.fixture
def story():
    """A robot that is sent somewhere, arrives, tells of an image, and is told to stop when it stands."""
    return SimpleNamespace(
        ledger=Ledger(told={TARGET: 1.0, STOP: 3.0}),
        faults=[Fault(GATEWAY_KILLED, 20.0, 21.0)],
        stored=Stored(
            {
                TARGET: SimpleNamespace(robot="sq01", op="SetPosEnd", state="reached", sa_id=5),
                STOP: SimpleNamespace(robot="sq01", op="Abort", state="reached", sa_id=6),
            },
            {
                TARGET: [step("queued", 1.0), step("acknowledged", 2.0), step("reached", 2.5)],
                STOP: [step("queued", 3.0), step("delivered", 3.1), step("reached", 3.5)],
            },
            [SimpleNamespace(robot="sq01", object="sq01-1-1", image=IMAGE)],
            Counter({("sq01", 10.0): 1}),
            [],
        ),
        lines=[
            line("acted", 1.5, op="SetPosEnd", number=1, id=5),
            line("acted", 3.2, op="Abort", id=6),
            line("accepted", 4.0, object="sq01-1-1", image=hashlib.sha256(IMAGE).hexdigest()),
            line("pose", 10.0, t=10.0),
            line("pose", 19.0, t=19.0),
        ],
        deaths=Deaths([Death(20.0, 20.2)], {"sq01": [Death(40.0, 40.1)]}),
    )


def wrong(story, *stops):
    return judged(story.ledger, story.faults, story.stored, story.lines, story.deaths, stops).wrong


def test_a_right_story_is_right_and_is_counted(story):
    findings = judged(story.ledger, story.faults, story.stored, story.lines, story.deaths)
    assert findings.wrong == []
    assert findings.counts["commands told queued"] == findings.counts["acted on"] == 2
    assert findings.counts["... lost, told at most 2 s before a gateway was killed"] == 1


def forget_command(story):
    del story.stored.commands[TARGET]


def go_back(story):
    story.stored.steps[TARGET].insert(2, step("delivered", 2.2))


def end_twice(story):
    story.stored.steps[TARGET].append(step("aborted", 2.6))


def stay_open(story):
    story.stored.commands[TARGET].state = "acknowledged"
    story.stored.steps[TARGET].pop()


def never_act(story):
    del story.lines[0]


def act_twice(story):
    story.lines.append(line("acted", 1.7, op="SetPosEnd", number=1, id=9))


def act_again_in_another_life(story):
    story.lines.append({**story.lines[0], "life": 2, "at": 2.1, "id": 9})


def test_a_robot_that_died_before_it_said_that_it_had_read_a_message_may_act_on_it_again(story):
    story.lines.append({**story.lines[0], "life": 2, "at": 2.1})
    assert wrong(story) == []


def act_late(story):
    story.lines[0]["at"] = 2.4


def act_after_the_abort(story):
    story.stored.commands[TARGET].state = "aborted"
    story.stored.steps[TARGET] = [step("queued", 1.0), step("aborted", 3.0)]
    story.lines[0]["at"] = 3.3


def act_on_what_nobody_sent(story):
    story.lines.append(line("acted", 5.0, op="SetPosEnd", number=2, id=9))


def lose_object(story):
    story.stored.observations.clear()


def store_twice(story):
    story.stored.observations.append(copy.copy(story.stored.observations[0]))


def spoil_image(story):
    story.stored.observations[0].image = b"another"


def lose_position(story):
    story.stored.positions.clear()


def lose_position_older_than_two_seconds(story):
    story.lines.append(line("pose", 17.9, t=17.9))


@pytest.mark.parametrize("death", [Death(30.02, 30.03), Death(29.9, 30.1)])
def test_what_a_robot_said_last_may_go_down_with_it(story, death):
    story.lines.append(line("pose", 30.0, t=30.0))
    story.deaths.robots["sq01"] = [death]
    assert wrong(story) == []


def test_what_a_robot_says_into_a_connection_that_died_slowly_may_be_lost(story):
    story.lines.append(line("pose", 20.6, t=20.6))
    assert wrong(story) == []


def lose_position_told_when_the_gateway_was_surely_dead(story):
    story.lines.append(line("pose", 20.8, t=20.8))


def lose_position_of_a_robot_that_lived_on(story):
    story.lines.append(line("pose", 30.0, t=30.0))
    story.deaths.robots["sq01"] = [Death(30.6, 30.7), Death(29.8, 29.9)]


def leave_message(story):
    story.stored.waiting.append(("sq01", "SetPosEnd"))


def be_refused_for_no_reason(story):
    story.ledger.wrong.append("command x was refused: no such robot")


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (forget_command, "is not in the database"),
        (go_back, "delivered after acknowledged"),
        (end_twice, "aborted after reached"),
        (stay_open, "it is acknowledged"),
        (never_act, "the robot never acted on it"),
        (act_twice, "acted on 2 times"),
        (act_again_in_another_life, "does not say that it was sent again"),
        (act_late, "0.40 s before the robot acted on it"),
        (act_after_the_abort, "acted on it after the Abort"),
        (act_on_what_nobody_sent, "the desk has no answer for it"),
        (lose_object, "not at all"),
        (store_twice, "is stored 2 times"),
        (spoil_image, "not stored as it was told"),
        (lose_position, "position of sq01"),
        (lose_position_older_than_two_seconds, "position of sq01"),
        (lose_position_told_when_the_gateway_was_surely_dead, "is lost"),
        (lose_position_of_a_robot_that_lived_on, "position of sq01"),
        (leave_message, "SetPosEnd of or for robot sq01 still waits"),
        (be_refused_for_no_reason, "no such robot"),
    ],
)
def test_one_thing_that_is_wrong_is_found(story, spoil, says):
    spoil(story)
    assert any(says in sentence for sentence in wrong(story)), wrong(story)


def test_what_an_emergency_stop_withdrew_need_not_have_been_acted_on(story):
    del story.lines[0]
    story.stored.commands[TARGET].state = "aborted"
    story.stored.steps[TARGET] = [step("queued", 1.0), step("delivered", 1.1), step("aborted", 2.5)]
    story.stored.commands[STOP].state = "superseded"
    story.stored.steps[STOP] = [step("queued", 3.0), step("superseded", 3.1)]
    assert wrong(story, (2.0, 2.2), (3.05, 3.1)) == []
    # A stop of before or afterwards withdrew nothing.
    story.stored.steps[TARGET][1].state = "acknowledged"
    (found,) = wrong(story, (3.05, 3.1))
    assert "never acted on it" in found
    (found,) = wrong(story, (0.9, 0.95), (9.0, 9.5))
    assert "it is superseded" in found
    # An Abort that was asked for while a stop was in force gives way to the stop's own, too.
    assert wrong(story, (0.5, 3.05)) == []
    # Acted on it counts.
    story.stored.steps[TARGET].insert(2, step("acknowledged", 1.2))
    story.lines.insert(0, line("acted", 1.15, op="SetPosEnd", number=1, id=5))
    story.lines.insert(1, line("acted", 1.16, op="SetPosEnd", number=1, id=7))
    assert any("acted on 2 times" in text for text in wrong(story, (2.0, 2.2), (3.05, 3.1)))


def test_what_an_abort_took_back_before_it_was_sent_need_not_have_been_acted_on(story):
    del story.lines[0]
    story.stored.commands[TARGET].state = "aborted"
    story.stored.steps[TARGET] = [step("queued", 1.0), step("delivered", 1.1), step("aborted", 3.1)]
    assert wrong(story) == []
    story.stored.steps[TARGET].insert(2, step("acknowledged", 1.2))
    assert wrong(story) == [f"command {TARGET}: acknowledged, and the robot never acted on it"]


def test_what_stops_and_refusals_must_keep_robots_from_is_found():
    stop = Stop("stop-0001", 10.0, {"sq01": 10.5}, ended=12.0)
    acted = [
        line("acted", at, op="SetPosEnd", number=number, id=number)
        for number, at in enumerate((10.4, 11.0, 12.1))
    ]
    assert list(moved_while_stopped(acted, [stop])) == [
        "sq01 was sent SetPosEnd 1 while stop-0001 was in force"
    ]
    refused = {"sq01-000000": "may have been done: look", "sq01-000002": "what was asked was not done"}
    assert [text.split()[1] for text in done_though_refused(acted, refused)] == ["sq01-000002"]


def test_a_gateway_is_replaced_when_its_last_robot_is_at_another_one():
    def ready(robot, at, address):
        return {"what": "ready", "robot": robot, "at": at, "address": address}

    lines = [ready("a", 1.0, "g0"), ready("b", 1.0, "g0"), ready("c", 1.0, "g1")]
    lines += [ready("c", 2.0, "g0"), ready("a", 10.3, "g1"), ready("c", 10.7, "g1"), ready("b", 11.5, "g1")]
    faults = [Fault(f"{GATEWAY_KILLED} g0", 10.0, 10.1), Fault("something else", 11.0, 11.1)]
    assert list(taken_up_again(lines, faults, ["g0", "g1"])) == [1.5]
