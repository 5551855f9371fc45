"""Aborts that are kept until the database takes them."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.robots import Abort, SetPosEnd
from robot_bridge.gateway.commands.active_command import CommandOrder, KeptAbort, UnstoredAborts


def abort(id, robot="r1", **how):
    return CommandOrder(id, robot, Abort(), "Ada", **how)


def orders(found):
    return [kept.order for kept in found]


class Notes:
    """What was noted here and elsewhere: ``left`` for robots, and what is ``settled``."""

    def __init__(self, *left):
        self.left, self.settled = left, []

    def write(self, _kept, settled):
        self.settled += settled

    def left_for(self, robots):
        return [left for left in self.left if left.order.robot in robots]


@pytest.fixture
def notes():
    return Notes()


@pytest.fixture
def kept(notes):
    return UnstoredAborts(notes)


def test_aborts_alone_are_kept_and_given_by_robot(kept):
    one, other = abort("abort-0001"), abort("abort-0002", "r2")
    target = CommandOrder("target-01", "r1", SetPosEnd(1.0, 2.0), "Ada")
    kept.keep([target, one, other])
    assert kept.robots() == ["r1", "r2"]
    assert orders(kept.of(["r2", "r3", "r1"])) == [other, one]
    assert orders(kept.of(["r3"])) == []


def test_a_robot_whose_abort_cannot_be_stored_comes_last(kept):
    kept.keep([abort("abort-0001"), abort("abort-0002", "r2"), abort("abort-0003", "r3")])
    kept.postpone("r1")
    assert kept.robots() == ["r2", "r3", "r1"]


def test_one_that_another_gateway_stores_meanwhile_is_not_put_last(kept):
    kept.keep([abort("abort-0001"), abort("abort-0002", "r2")])
    kept.discard_settled({"abort-0001"})
    kept.postpone("r1")
    assert kept.robots() == ["r2"]


def test_a_newer_one_takes_the_place_of_the_one_before_and_none_of_one_for_a_command(kept):
    one, newer, single = abort("abort-0001"), abort("abort-0002"), abort("abort-0003", aborts="target-01")
    kept.keep([one, single, newer])
    assert orders(kept.of(["r1"])) == [newer, single]


@pytest.mark.parametrize("aborts", [None, "target-01"])
def test_one_that_is_discarded_is_forgotten_with_its_robot(kept, aborts):
    one, other = abort("abort-0001", aborts=aborts), abort("abort-0002", aborts="target-02")
    kept.keep([one, other])
    kept.discard(one)
    assert orders(kept.of(["r1"])) == [other] and kept.robots() == ["r1"]
    kept.discard(other)
    kept.discard(other)
    assert orders(kept.of(["r1"])) == [] and kept.robots() == []


def test_a_newer_one_stays_when_the_one_before_is_discarded(kept):
    one, newer = abort("abort-0001"), abort("abort-0001")
    kept.keep([newer])
    kept.discard(one)
    assert orders(kept.of(["r1"])) == [newer]


def left(id, at, **how):
    return KeptAbort(abort(id, **how), at, is_left=True)


def test_one_that_another_gateway_left_takes_no_newer_one_s_place(kept, notes):
    kept.keep_left([left("abort-0002", 20.0), left("abort-0001", 10.0)])
    assert orders(kept.of(["r1"])) == [abort("abort-0002")]
    kept.keep_left([left("abort-0003", 30.0)])
    kept.keep([abort("abort-0004")])
    kept.keep_left([left("abort-0002", 20.0)])
    assert orders(kept.of(["r1"])) == [abort("abort-0004")]
    kept.write_notes()
    assert sorted(set(notes.settled)) == ["abort-0001", "abort-0002", "abort-0003"]


def test_one_that_is_asked_for_here_as_well_is_as_old_as_it_was_and_judged_by_nothing_that_came_since(
    kept, notes
):
    kept.keep_left([left("abort-0001", 10.0)])
    kept.keep([abort("abort-0001")])
    assert kept.of(["r1"]) == [KeptAbort(abort("abort-0001"), 10.0)]
    kept.keep_left([left("abort-0001", 20.0)])
    assert kept.of(["r1"]) == [KeptAbort(abort("abort-0001"), 10.0)]
    kept.write_notes()
    assert notes.settled == []


def test_those_of_a_robot_that_goes_to_another_gateway_are_left_to_that_and_come_back_with_it(kept, notes):
    notes.left = (left("abort-0001", 10.0),)
    kept.keep([abort("abort-0001")])
    kept.drop("r1")
    kept.write_notes()
    assert (kept.robots(), notes.settled) == ([], [])
    kept.keep_left_for(["r1", "r2"])
    assert kept.of(["r1"]) == [left("abort-0001", 10.0)]


def test_those_of_a_robot_that_is_removed_end_wherever_they_are_noted(kept, notes):
    notes.left = (left("abort-0002", 10.0, aborts="target-01"),)
    kept.keep([abort("abort-0001")])
    kept.end(["r1"])
    kept.write_notes()
    assert (kept.robots(), sorted(notes.settled)) == ([], ["abort-0001", "abort-0002"])


def test_those_that_another_gateway_has_stored_are_kept_no_longer(kept, notes):
    kept.keep([abort("abort-0001"), abort("abort-0002", "r2")])
    kept.discard_settled({"abort-0002", "abort-0003"})
    assert kept.robots() == ["r1"]
