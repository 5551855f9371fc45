"""Aborts that are kept until the database takes them."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.robots import Abort, SetPosEnd
from robot_bridge.gateway.commands.active_command import CommandOrder
from robot_bridge.gateway.commands.persistence import UnstoredAborts


def abort(id, robot="r1", **how):
    return CommandOrder(id, robot, Abort(), "Ada", **how)


@pytest.fixture
def kept():
    return UnstoredAborts()


def test_aborts_alone_are_kept_and_given_by_robot(kept):
    one, other = abort("abort-0001"), abort("abort-0002", "r2")
    target = CommandOrder("target-01", "r1", SetPosEnd(1.0, 2.0), "Ada")
    kept.keep([target, one, other])
    assert kept.robots() == ["r1", "r2"]
    assert kept.of(["r2", "r3", "r1"]) == [other, one]
    assert kept.of(["r3"]) == []


def test_a_robot_whose_abort_cannot_be_stored_comes_last(kept):
    kept.keep([abort("abort-0001"), abort("abort-0002", "r2"), abort("abort-0003", "r3")])
    kept.postpone("r1")
    assert kept.robots() == ["r2", "r3", "r1"]


def test_a_newer_one_takes_the_place_of_the_one_before_and_none_of_one_for_a_command(kept):
    one, newer, single = abort("abort-0001"), abort("abort-0002"), abort("abort-0003", aborts="target-01")
    kept.keep([one, single, newer])
    assert kept.of(["r1"]) == [newer, single]


@pytest.mark.parametrize("aborts", [None, "target-01"])
def test_one_that_is_discarded_is_forgotten_with_its_robot(kept, aborts):
    one, other = abort("abort-0001", aborts=aborts), abort("abort-0002", aborts="target-02")
    kept.keep([one, other])
    kept.discard(one)
    assert kept.of(["r1"]) == [other] and kept.robots() == ["r1"]
    kept.discard(other)
    kept.discard(other)
    assert kept.of(["r1"]) == [] and kept.robots() == []


def test_a_newer_one_stays_when_the_one_before_is_discarded(kept):
    one, newer = abort("abort-0001"), abort("abort-0001")
    kept.keep([newer])
    kept.discard(one)
    assert kept.of(["r1"]) == [newer]
