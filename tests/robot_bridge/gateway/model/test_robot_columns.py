"""Robots of other gateways: many are taken in as each by itself, and of one's own nothing is."""

from __future__ import annotations

import math
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.core.clock import ClockStep
from robot_bridge.core.messages.positions import link_elsewhere
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.messages.safety import RobotState
from robot_bridge.gateway.model.robot_columns import (
    BATTERY,
    DOUBTED,
    ENDED,
    HEARD_SINCE,
    LOCATED,
    ONLY_SEEN,
    STATES,
    DescribedElsewhere,
    ReportedElsewhere,
    liveness,
    state_codes,
)
from robot_bridge.gateway.model.robots import Robot, Robots

NOW = 1000.0
HERE = (1.0, 2.0, 0.5, 0.25)


def told(names, places=None, *, by="south", pose_age=0.0, age=0.0, flags=LOCATED, wall=NOW):
    places = [HERE] * len(names) if places is None else places
    return numbered(
        [zlib.crc32(name.encode()) % 1000 for name in names],
        names,
        places,
        by=by,
        pose_age=pose_age,
        age=age,
        flags=flags,
        wall=wall,
    )


def numbered(ids, names, places=None, *, by="south", run=1, pose_age=0.0, age=0.0, flags=LOCATED, wall=NOW):
    places = [HERE] * len(ids) if places is None else places
    table = np.array([(*place, pose_age, age) for place in places], dtype="<f4").reshape(-1, 6)
    ids, flags = np.array(ids, dtype=np.uint32), np.full(len(ids), flags, dtype=np.uint8)
    return ReportedElsewhere(by, run, ids, names, table, flags, wall)


@pytest.fixture
def robots() -> Robots:
    robots = Robots(stale_after=3.0, lost_after=10.0)
    robots.ready("mine", 7, "websocket", NOW)
    robots.observe_elsewhere(told(["theirs"]))
    return robots


def test_a_robot_that_another_gateway_tells_of_is_known(robots):
    one = robots.get("theirs")
    assert one == Robot(
        "theirs",
        0,
        link_elsewhere("south"),
        NOW,
        pose=SendPos(*HERE),
        pose_at=NOW,
        located=True,
        gateway="south",
        revision=robots.revision,
        described=one.described,
        order=one.order,
    )
    assert "theirs" in robots and robots.count() == 2 and robots.names() == ["mine", "theirs"]
    assert (robots.gateway_of("theirs"), robots.gateway_of("mine")) == ("south", None)
    assert (robots.commanded(), robots.commanded_elsewhere()) == (["mine"], ["theirs"])
    assert robots.is_placed("theirs")
    assert [robot.name for robot in robots.own()] == ["mine"]


def test_of_robots_of_this_gateway_and_of_a_third_one_nothing_is_taken_in(robots):
    robots.observe("mine", SendPos(9.0, 9.0, 0.0, 0.0), "websocket", NOW)
    seen = robots.revision
    robots.observe_elsewhere(told(["mine"]))
    robots.observe_elsewhere(told(["theirs"], [(5.0, 5.0, 0.0, 0.0)], by="west"))
    robots.describe_elsewhere("theirs", "west", DescribedElsewhere(0.1, "odd", None, None, None, None))
    assert robots.changed(seen) == []
    assert (robots.pose("mine").x, robots.pose("theirs")) == (9.0, SendPos(*HERE))


def test_a_robot_that_went_to_a_third_gateway_is_taken_from_that(robots):
    robots.let_go("theirs", "west")
    robots.observe_elsewhere(told(["theirs"], [(5.0, 5.0, 0.0, 0.0)]))
    assert robots.pose("theirs") == SendPos(*HERE)
    robots.observe_elsewhere(told(["theirs"], [(6.0, 5.0, 0.0, 0.0)], by="west"))
    assert (robots.pose("theirs").x, robots.get("theirs").link) == (6.0, link_elsewhere("west"))


def test_a_robot_that_is_let_go_and_comes_back_keeps_its_place(robots):
    robots.observe("mine", SendPos(9.0, 9.0, 0.0, 0.0, battery=0.5, status="busy"), "websocket", NOW)
    robots.let_go("mine", "south")
    assert robots.own() == [] and robots.pose("mine") == SendPos(9.0, 9.0, 0.0, 0.0, None, 0.5, "busy")
    robots.observe_elsewhere(told(["mine"]))
    # What changes seldom comes by itself.
    assert robots.pose("mine") == SendPos(*HERE, None, 0.5, "busy")
    robots.ready("mine", 7, "websocket", NOW + 1)
    robots.observe_elsewhere(told(["mine"], [(5.0, 5.0, 0.0, 0.0)]))
    assert robots.pose("mine") == SendPos(*HERE, None, 0.5, "busy")
    assert robots.gateway_of("mine") is None and robots.commanded() == ["mine"]


def test_what_is_not_known_or_no_place_moves_nobody(robots):
    nowhere = [
        (math.nan, 1.0, 0.0, 0.0),
        (2e8, 1.0, 0.0, 0.0),
        (1.0, 1.0, 0.0, 200.0),
        (1.0, -math.inf, 0, 0),
    ]
    for place in nowhere:
        robots.observe_elsewhere(told(["theirs", "new"], [place, place], wall=NOW + 5))
        assert robots.pose("theirs") == SendPos(*HERE) and robots.pose("new") is None
    # It is heard all the same.
    assert robots.get("theirs").received_at == robots.get("new").received_at == NOW + 5
    robots.observe_elsewhere(told(["theirs", "other"], age=math.nan, wall=NOW + 9))
    assert "other" not in robots and robots.get("theirs").received_at == NOW + 5


def test_a_heading_is_kept_within_half_a_turn(robots):
    robots.observe_elsewhere(told(["theirs"], [(1.0, 1.0, 4.0, 0.0)]))
    assert robots.pose("theirs").theta == pytest.approx(4.0 - 2 * math.pi)


def test_details_that_are_said_again_are_no_change(robots):
    said = DescribedElsewhere(0.1, "odd", "it jumps", 0.2, None, "map", 7)
    for one, changes in ((said, True), (said, False), (said._replace(status=None), True)):
        seen = robots.revision
        robots.describe_elsewhere("theirs", "south", one)
        assert (robots.revision > seen) is changes
    for field, value in (
        ("battery", 0.2),
        ("doubt", None),
        ("latency", 0.4),
        ("abilities", "x"),
        ("magic", 8),
        ("magic", 0),
    ):
        seen, said = robots.revision, said._replace(status=None, **{field: value})
        robots.describe_elsewhere("theirs", "south", said)
        assert robots.revision > seen, field


def test_details_go_with_the_place_until_others_come(robots):
    robots.describe_elsewhere(
        "theirs", "south", DescribedElsewhere(0.5, "busy", "it leapt", 0.01, None, None, 9)
    )
    robots.observe_elsewhere(told(["theirs"], [(5.0, 5.0, 0.0, 0.0)]))
    one = robots.get("theirs")
    assert (one.pose.x, one.pose.battery, one.pose.status, one.doubt, one.latency) == (
        5.0,
        0.5,
        "busy",
        "it leapt",
        0.01,
    )
    places = robots.places()
    row = places.names.index("theirs")
    assert (places.table[BATTERY, row], places.flags[row]) == (0.5, LOCATED | DOUBTED)


def test_only_what_changed_has_a_newer_revision(robots):
    robots.observe_elsewhere(told(["a", "b", "c"]))
    seen = robots.revision
    robots.observe_elsewhere(told(["b"], wall=NOW + 1))
    assert [robot.name for robot in robots.changed(seen)] == ["b"]
    assert robots.places(seen).names == ["b"]
    assert {robot.name for robot in robots.changed(-1)} == {"mine", "theirs", "a", "b", "c"}
    robots.assign("c", "task")
    assert [(robot.name, robot.command) for robot in robots.changed(seen)][1:] == [("c", "task")]
    assert robots.doing("task") == "c"


def test_a_robot_that_was_removed_leaves_nothing_to_the_next_one(robots):
    seen = robots.revision
    robots.remove("theirs")
    assert robots.removed(seen) == ["theirs"] and "theirs" not in robots and robots.count() == 1
    assert robots.places().names == ["mine"] and robots.known(["theirs"]) == []
    robots.observe_elsewhere(told(["next"], [(math.nan, 0.0, 0.0, 0.0)]))
    assert robots.get("next").pose is None and not robots.is_unseen("next", NOW)
    robots.observe_elsewhere(told(["theirs"]))
    assert robots.removed(seen) == [] and robots.get("theirs").pose == SendPos(*HERE)


def test_silence_ages_them_as_those_of_this_gateway(robots):
    robots.observe_elsewhere(told(["ended"], flags=ENDED | LOCATED))
    robots.observe_elsewhere(told(["stood"], flags=ENDED | HEARD_SINCE | LOCATED))
    seen = robots.revision
    robots.age(NOW + 2.9)
    assert robots.changed(seen) == []
    robots.age(NOW + 3.0)
    states = {robot.name: robot.state for robot in robots.changed(seen)}
    stale = dict.fromkeys(["mine", "theirs", "stood"], RobotState.STALE)
    assert states == {**stale, "ended": RobotState.OFFLINE}
    robots.observe_elsewhere(told(["seen"], flags=ONLY_SEEN | LOCATED, wall=NOW + 8))
    assert [robot.name for robot in robots.only_seen()] == ["seen"]
    robots.age(NOW + 10.0)
    assert robots.get("theirs").state is robots.get("stood").state is RobotState.LOST
    assert robots.get("seen").state is RobotState.FRESH


def test_a_clock_that_is_set_keeps_the_time_since_they_were_heard(robots):
    robots.clock_was_set(ClockStep(by=-500.0, since=NOW - 500 + 20, now=NOW - 500 + 21))
    one = robots.get("theirs")
    robots.observe_elsewhere(told(["other"], wall=NOW - 479))
    assert (robots.get("mine").received_at, one.received_at, one.pose_at) == (NOW - 500,) * 3
    robots.age(NOW - 500 + 9)
    assert robots.get("theirs").state is RobotState.STALE


ages = st.floats(0, 30) | st.sampled_from([3.0, 10.0])


@given(st.lists(st.tuples(ages, st.booleans())), ages, ages)
def test_many_are_judged_as_one(some, stale_after, lost_after):
    ages, ended = [age for age, _ in some], [ended for _, ended in some]
    found = state_codes(np.array(ages), np.array(ended, dtype=np.bool_), stale_after, lost_after)
    assert [STATES[code] for code in found.tolist()] == [
        liveness(age, ended_in_order=end, stale_after=stale_after, lost_after=lost_after) for age, end in some
    ]


batches = st.lists(
    st.tuples(
        st.sampled_from(["south", "west"]),
        st.lists(
            st.tuples(st.sampled_from("abcdef"), st.floats(-9, 9, width=32)), unique_by=lambda one: one[0]
        ),
    )
)


@given(batches)
def test_a_batch_says_what_its_robots_say_one_by_one(batches):
    together, one_by_one = Robots(), Robots()
    for by, said in batches:
        together.observe_elsewhere(told([n for n, _ in said], [(x, 0, 0, 0) for _, x in said], by=by))
        for name, x in said:
            one_by_one.observe_elsewhere(told([name], [(x, 0, 0, 0)], by=by))
        # Somebody looks between two.
        assert together.names() == one_by_one.names()
    for name in together.names():
        mine, other = together.get(name), one_by_one.get(name)
        assert (mine.pose, mine.gateway, mine.state) == (other.pose, other.gateway, other.state)


def at(x):
    return (x, 0.0, 0.0, 0.0)


def test_a_robot_that_was_named_is_known_by_its_number(robots):
    assert robots.observe_elsewhere(numbered([4, 9], ["a", "b"], [at(1), at(2)]))
    assert robots.observe_elsewhere(numbered([9, 4], [], [at(3), at(4)]))
    assert (robots.pose("a").x, robots.pose("b").x) == (4.0, 3.0)
    assert robots.observe_elsewhere(numbered([2, 9], ["c"], [at(5), at(6)]))
    assert (robots.pose("c").x, robots.pose("b").x) == (5.0, 6.0)


def test_numbers_that_were_not_named_move_nobody_and_are_asked_for(robots):
    robots.observe_elsewhere(numbered([4], ["a"], [at(1)]))
    seen = robots.revision
    for told in (
        numbered([5], [], [at(2)]),
        numbered([900_000], [], [at(2)]),
        numbered([4], [], [at(2)], run=2),
        numbered([4], [], [at(2)], by="west"),
    ):
        assert not robots.observe_elsewhere(told)
        assert robots.changed(seen) == []


def test_a_number_means_no_robot_that_came_into_its_row_later(robots):
    robots.observe_elsewhere(numbered([4], ["a"], [at(1)]))
    robots.remove("a")
    robots.observe_elsewhere(numbered([1], ["b"], [at(2)]))
    assert not robots.observe_elsewhere(numbered([4], [], [at(9)]))
    assert robots.pose("b").x == 2.0 and "a" not in robots
    assert robots.observe_elsewhere(numbered([4], ["a"], [at(3)]))
    assert robots.observe_elsewhere(numbered([4, 1], [], [at(4), at(5)]))
    assert (robots.pose("a").x, robots.pose("b").x) == (4.0, 5.0)


def test_what_is_said_of_a_robot_of_this_gateway_is_left_and_not_asked_for(robots):
    assert robots.observe_elsewhere(numbered([3], ["mine"], [at(1)]))
    assert robots.observe_elsewhere(numbered([3], [], [at(2)]))
    assert robots.pose("mine") is None and robots.gateway_of("mine") is None


def test_a_robot_that_goes_elsewhere_is_asked_for_where_it_was_named_before_that_was_known(robots):
    """The message in which it is named again, as others ask for then, may be lost."""
    assert robots.observe_elsewhere(numbered([3], ["mine"], [at(1)]))
    robots.let_go("mine", "south")
    assert not robots.observe_elsewhere(numbered([3], [], [at(2)]))
    assert robots.observe_elsewhere(numbered([3], ["mine"], [at(3)]))
    assert robots.observe_elsewhere(numbered([3], [], [at(4)]))
    assert robots.pose("mine").x == 4.0


def test_robots_of_gateways_that_are_left_out_are_left_out(robots):
    robots.observe_elsewhere(told(["c"], by="north"))
    for without, names in (
        ((), ["mine", "theirs", "c"]),
        (["south"], ["mine", "c"]),
        (["south", "west"], ["mine", "c"]),
        (["south", "north"], ["mine"]),
    ):
        places = robots.places(without=without)
        assert places.names == names
        assert places.table.shape[1] == len(places.states) == len(places.flags) == len(names)
