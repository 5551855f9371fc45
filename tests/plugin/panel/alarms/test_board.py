"""Each alarm begins, trembles and ends on plain arrays."""

from dataclasses import replace

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.plugin.panel.alarms.board import AlarmBoard, robots_of
from fleet_supervisor.plugin.panel.alarms.rules import (
    FRESH,
    LOST,
    OFFLINE,
    AlarmChange,
    AlarmKind,
    AlarmSnapshot,
    Thresholds,
)
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState

BEGAN, ENDED, SEEN = AlarmChange.BEGAN, AlarmChange.ENDED, AlarmChange.ACKNOWLEDGED
STALE = STATES.index(RobotState.STALE)


def situation(count=2, **more) -> AlarmSnapshot:
    """Robots 10 m from each other, well, with nothing to do."""
    values = {
        "names": [f"r{k + 1}" for k in range(count)],
        "xy": np.column_stack([np.arange(count) * 10.0 + 5, np.full(count, 5.0)]),
        "v": np.full(count, 1.0),
        "battery": np.full(count, 0.9),
        "accuracy": np.full(count, 0.05),
        "state": np.full(count, FRESH),
        "stopped": np.zeros(count, dtype=bool),
        "driving": np.zeros(count, dtype=bool),
        "only_seen": np.zeros(count, dtype=bool),
        "bounds": (0.0, 0.0, 200.0, 100.0),
        "doubted": np.zeros(count, dtype=bool),
        "doubts": {},
    }
    return AlarmSnapshot(**{**values, **{name: np.array(v) for name, v in more.items() if name != "bounds"}})


def doubted(*rows, **more) -> AlarmSnapshot:
    """The same, with some that may not be where they are shown."""
    now = situation(doubted=[row in rows for row in range(2)], **more)
    return replace(now, doubts=dict.fromkeys(rows, "it leapt"))


class Looking:
    """Looks every half second of its own clock and keeps what happened."""

    def __init__(self, **limits):
        self.board = AlarmBoard(Thresholds(**limits))
        self.now = 100.0

    def look(self, now: AlarmSnapshot, seconds: float = 3.0) -> list:
        events = []
        for _ in range(round(seconds / 0.5)):
            self.now += 0.5
            events += self.board.evaluate(now, self.now, 1_700_000_000 + self.now)
        return [(event.change, event.alarm.kind, robots_of(event.alarm)) for event in events]


@pytest.fixture
def desk():
    return Looking()


def test_all_is_well(desk):
    assert desk.look(situation(), 30) == []


# --- one robot ---


@pytest.mark.parametrize(
    ("kind", "wrong", "between", "right"),
    [
        (AlarmKind.LOST, {"state": [LOST, FRESH]}, {"state": [STALE, FRESH]}, {}),
        (
            AlarmKind.UNSURE,
            {"accuracy": [2.0, 0.05]},
            {"accuracy": [1.6, 0.05]},
            {"accuracy": [1.4, 0.05]},
        ),
        (AlarmKind.LOW_BATTERY, {"battery": [0.19, 0.9]}, {"battery": [0.24, 0.9]}, {"battery": [0.25, 0.9]}),
        (
            AlarmKind.OUTSIDE_SITE,
            {"xy": [(200.6, 5), (15, 5)]},
            {"xy": [(200.4, 5), (15, 5)]},
            {"xy": [(199.9, 5), (15, 5)]},
        ),
        (
            AlarmKind.OFF_ROAD,
            {"off_road": [True, False], "on_road": [False, True]},
            {"off_road": [False, False], "on_road": [False, True]},
            {"off_road": [False, False], "on_road": [True, True]},
        ),
        (
            AlarmKind.STOPPED,
            {"driving": [True, False], "v": [0.0, 0.0]},
            {"driving": [True, False], "v": [0.1, 0.0]},
            {"driving": [True, False], "v": [0.3, 0.0]},
        ),
    ],
)
def test_an_alarm_begins_beyond_its_threshold_and_ends_well_within(desk, kind, wrong, between, right):
    assert desk.look(situation(**between), 20) == []
    assert desk.look(situation(**wrong), 20) == [(BEGAN, kind, "r1")]
    for _ in range(10):
        # A value that trembles about the threshold is one alarm.
        assert desk.look(situation(**between), 3) == []
        assert desk.look(situation(**wrong), 15) == []
    assert desk.look(situation(**right), 3) == [(ENDED, kind, "r1")]


@pytest.mark.parametrize(
    "values",
    [
        {"state": [LOST, FRESH]},
        {"battery": [0.05, 0.9]},
        {"accuracy": [40.0, 0.05]},
        {"doubted": [True, False]},
        {"xy": [(-50, 5), (15, 5)]},
        {"off_road": [True, False], "on_road": [False, True]},
    ],
)
def test_what_lasts_a_moment_only_is_no_alarm(desk, values):
    for _ in range(5):
        assert desk.look(situation(**values), 0.5) == []
        assert desk.look(situation(), 0.5) == []


@pytest.mark.parametrize("bounds_side", [(-0.6, 5), (200.6, 5), (5, -0.6), (5, 100.6)])
def test_every_side_of_the_site_counts(desk, bounds_side):
    found = desk.look(situation(xy=[bounds_side, (50, 50)]))
    assert found == [(BEGAN, AlarmKind.OUTSIDE_SITE, "r1")]


def test_a_robot_without_place_battery_or_speed_is_no_alarm(desk):
    nothing = [np.nan, np.nan]
    unknown = situation(
        xy=[nothing, nothing], battery=nothing, accuracy=nothing, v=nothing, driving=[True, True]
    )
    assert desk.look(unknown, 30) == []


def test_a_robot_that_went_in_good_order_is_not_lost(desk):
    assert desk.look(situation(state=[LOST, FRESH])) == [(BEGAN, AlarmKind.LOST, "r1")]
    assert desk.look(situation(state=[OFFLINE, FRESH])) == [(ENDED, AlarmKind.LOST, "r1")]
    assert desk.look(situation(state=[OFFLINE, FRESH]), 20) == []


@pytest.mark.parametrize(
    "later", [{"accuracy": [np.nan, 0.05]}, {"accuracy": [9.0, 0.05], "state": [OFFLINE, FRESH]}]
)
def test_a_robot_that_says_no_more_of_its_accuracy_or_goes_is_not_unsure(desk, later):
    assert desk.look(situation(accuracy=[9.0, 0.05])) == [(BEGAN, AlarmKind.UNSURE, "r1")]
    # What was said before it fell silent is neither news nor over.
    assert desk.look(situation(accuracy=[9.0, 0.05], state=[STALE, FRESH])) == []
    assert desk.look(situation(**later)) == [(ENDED, AlarmKind.UNSURE, "r1")]


def test_a_robot_that_may_be_elsewhere_is_unsure_with_the_reason_until_it_is_believed(desk):
    assert desk.look(doubted(0)) == [(BEGAN, AlarmKind.UNSURE, "r1")]
    (alarm,) = desk.board.alarms()
    assert alarm.text == "r1 may not be where it is shown: it leapt"
    # For a moment only it was believed.
    assert desk.look(situation(), 0.5) + desk.look(doubted(0)) == []
    assert desk.look(doubted(0, state=[STALE, FRESH])) == []
    assert desk.look(situation(state=[STALE, FRESH])) == []
    assert desk.look(situation()) == [(ENDED, AlarmKind.UNSURE, "r1")]


def test_who_does_not_know_its_place_and_then_leaps_is_told_of_again(desk):
    lost_itself = {"accuracy": [9.0, 0.05]}
    assert desk.look(situation(**lost_itself)) == [(BEGAN, AlarmKind.UNSURE, "r1")]
    desk.board.acknowledge([desk.board.alarms()[0].key], "anna", desk.now)
    assert desk.look(doubted(0, **lost_itself)) == [(BEGAN, AlarmKind.UNSURE, "r1")]
    (alarm,) = desk.board.alarms()
    assert alarm.is_new and alarm.text == "r1 may not be where it is shown: it leapt"
    # Believed again, it still does not know its place.
    assert desk.look(situation(**lost_itself)) == []
    assert desk.look(situation()) == [(ENDED, AlarmKind.UNSURE, "r1")]


def test_a_margin_as_large_as_the_limit_still_lets_the_alarm_end():
    desk = Looking(unsure=2.0, unsure_margin=5.0)
    assert desk.look(situation(accuracy=[2.5, 0.05])) == [(BEGAN, AlarmKind.UNSURE, "r1")]
    assert desk.look(situation(accuracy=[1.1, 0.05])) == []
    assert desk.look(situation(accuracy=[0.9, 0.05])) == [(ENDED, AlarmKind.UNSURE, "r1")]


def test_standing_is_an_alarm_after_its_time_with_a_task_only(desk):
    stands = situation(v=[0.0, 0.0], driving=[True, False])
    assert desk.look(stands, 9.5) == []
    assert desk.look(stands, 1.0) == [(BEGAN, AlarmKind.STOPPED, "r1")]
    assert desk.look(situation(v=[0.0, 0.0]), 2) == [(ENDED, AlarmKind.STOPPED, "r1")]


def test_a_robot_that_says_stopped_with_a_task_is_an_alarm_whatever_its_speed(desk):
    assert desk.look(situation(stopped=[True, False], driving=[True, False]), 11) == [
        (BEGAN, AlarmKind.STOPPED, "r1")
    ]


def test_a_stale_robot_is_not_said_to_stand(desk):
    silent = situation(v=[0.0, 0.0], driving=[True, True], state=[STALE, LOST])
    assert [kind for _, kind, _ in desk.look(silent, 30)] == [AlarmKind.LOST]


def test_without_surfaces_nobody_is_off_the_road(desk):
    wrong = {"off_road": [True, False], "on_road": [False, True]}
    assert desk.look(situation(**wrong)) == [(BEGAN, AlarmKind.OFF_ROAD, "r1")]
    assert desk.look(situation()) == [(ENDED, AlarmKind.OFF_ROAD, "r1")]


# --- two robots ---


def apart(metres, **more):
    return situation(xy=[(50, 50), (50 + metres, 50)], **more)


def test_two_are_too_close_until_they_are_clearly_apart(desk):
    kind = AlarmKind.TOO_CLOSE
    assert desk.look(apart(1.01)) == []
    assert desk.look(apart(0.99)) == [(BEGAN, kind, "r1 and r2")]
    assert desk.look(apart(1.2)) == []
    assert desk.look(apart(0.9)) == []
    assert desk.look(apart(1.31)) == [(ENDED, kind, "r1 and r2")]
    assert desk.look(apart(1.2)) == []


def test_robots_parked_beside_each_other_are_not_too_close(desk):
    assert desk.look(apart(0.5, state=[OFFLINE, OFFLINE])) == []
    assert desk.look(apart(0.5, state=[OFFLINE, FRESH])) == [(BEGAN, AlarmKind.TOO_CLOSE, "r1 and r2")]


def test_a_place_that_is_not_known_is_near_to_nobody(desk):
    assert desk.look(situation(xy=[(np.nan, np.nan), (np.nan, np.nan)])) == []


def test_three_make_three_pairs_and_new_robots_keep_old_alarms(desk):
    assert len(desk.look(apart(0.5))) == 1
    three = situation(3, xy=[(50, 50), (50.5, 50), (50.2, 50.2)])
    assert {name for _, _, name in desk.look(three)} == {"r1 and r3", "r2 and r3"}
    assert len(desk.board.alarms()) == 3


# --- settings ---


def test_thresholds_are_settings():
    desk = Looking(low_battery=0.5, too_close=3.0, outside_margin=10.0, stopped_after=2.0)
    assert desk.look(situation(battery=[0.45, 0.9])) == [(BEGAN, AlarmKind.LOW_BATTERY, "r1")]
    assert desk.look(apart(2.5, battery=[0.45, 0.9])) == [(BEGAN, AlarmKind.TOO_CLOSE, "r1 and r2")]
    assert [kind for _, kind, _ in desk.look(situation(xy=[(-9, 5), (15, 5)], battery=[0.45, 0.9]))] == [
        AlarmKind.TOO_CLOSE
    ]


def test_who_is_only_seen_is_too_close_to_nobody_here(desk):
    assert desk.look(situation(xy=[(5, 5), (5.3, 5)], only_seen=[False, True])) == []


BY_THE_GATEWAY = {
    AlarmKind.IN_KEEPOUT,
    AlarmKind.AT_OBSTACLE,
    AlarmKind.WILL_PASS,
    AlarmKind.NEAR_ROBOT,
    AlarmKind.COMES_NEAR,
}
HERE = [kind for kind in AlarmKind if kind not in BY_THE_GATEWAY]


@pytest.mark.parametrize("kind", HERE)
def test_what_is_switched_off_is_not_watched_and_ends(kind):
    desk = Looking(kinds=frozenset(AlarmKind) - {kind})
    wrong = situation(
        3,
        xy=[(-9, 5), (-9.5, 5), (50, 50)],
        battery=[0.1, 0.9, 0.9],
        accuracy=[3.0, 0.1, 0.1],
        state=[FRESH, FRESH, LOST],
        v=[0.0, 1.0, 1.0],
        driving=[True, False, False],
        off_road=[True, False, False],
        on_road=[False, False, False],
    )
    found = {found for _, found, _ in desk.look(wrong, 20)}
    assert found == set(HERE) - {kind}
    desk.board.set_limits(Thresholds(kinds=frozenset()))
    desk.look(wrong)
    assert all(alarm.ended is not None for alarm in desk.board.alarms())


@pytest.mark.parametrize("wrong", [{"low_battery": 1.2}, {"too_close": -1}, {"stopped_after": 0}])
def test_settings_out_of_range_are_refused_by_name(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        Thresholds(**wrong)


# --- acknowledging and the log ---


def test_an_alarm_goes_when_it_is_over_and_was_seen_in_whatever_order(desk):
    low, well = situation(battery=[0.1, 0.9]), situation()
    desk.look(low)
    (alarm,) = desk.board.alarms()
    desk.board.acknowledge([alarm.key], "anna", 5.0)
    (seen,) = desk.board.alarms()
    assert (seen.is_new, seen.by, seen.acknowledged) == (False, "anna", 5.0)
    desk.look(well)
    assert desk.board.alarms() == []

    desk.look(low)
    desk.look(well)
    (over,) = desk.board.alarms()
    assert over.is_new and over.ended is not None
    desk.board.acknowledge([over.key], "anna", 6.0)
    assert desk.board.alarms() == []


def test_what_comes_again_unseen_is_one_alarm_that_counts(desk):
    for _ in range(4):
        desk.look(situation(battery=[0.1, 0.9]))
        desk.look(situation())
    (alarm,) = desk.board.alarms()
    assert alarm.times == 4
    desk.board.acknowledge([alarm.key], "anna", 1.0)
    desk.look(situation(battery=[0.1, 0.9]))
    assert [alarm.times for alarm in desk.board.alarms()] == [1]


def test_the_log_has_every_change_in_order_with_who_saw_it(desk):
    desk.look(situation(battery=[0.1, 0.9]))
    desk.board.acknowledge([desk.board.alarms()[0].key], "anna", 7.0)
    desk.board.acknowledge([desk.board.log[0].alarm.key], "bert", 8.0)
    desk.look(situation())
    happened = [(event.change, event.by) for event in desk.board.log]
    assert happened == [(BEGAN, ""), (SEEN, "anna"), (ENDED, "")]


def test_new_alarms_come_first_then_what_presses_most(desk):
    desk.look(situation(4, battery=[0.1, 0.1, 0.9, 0.9], state=[FRESH, FRESH, LOST, FRESH]))
    desk.board.acknowledge([desk.board.alarms()[0].key], "anna", 1.0)
    kinds = [(alarm.is_new, alarm.kind) for alarm in desk.board.alarms()]
    assert kinds == [
        (True, AlarmKind.LOW_BATTERY),
        (True, AlarmKind.LOW_BATTERY),
        (False, AlarmKind.LOST),
    ]


def test_another_site_has_no_alarms_of_this_one(desk):
    desk.look(situation(battery=[0.1, 0.9], xy=[(5, 5), (5.5, 5)]))
    assert len(desk.board.alarms()) == 2
    desk.board.clear()
    assert desk.board.alarms() == []
    assert desk.look(situation()) == []
    assert len(desk.board.log) == 2


def test_texts_say_who_what_and_where(desk):
    desk.look(replace(situation(battery=[0.1, 0.9]), xy=np.array([(5.0, 5.0), (5.5, 5.0)])))
    assert [alarm.text for alarm in desk.board.alarms()] == [
        "r1 and r2 are 0.5 m apart at 5.0, 5.0 m",
        "r1 has 10% of its battery left",
    ]


def test_alarms_that_nobody_acknowledges_do_not_grow_for_ever(desk):
    from fleet_supervisor.plugin.panel.alarms.board import MOST_ALARMS

    count = MOST_ALARMS + 300
    low = np.full(count, 0.9)
    low[-1] = 0.1
    k = np.arange(count)
    xy = np.column_stack([k % 20 * 9.0 + 5, k // 20 * 1.4 + 5])
    desk.look(situation(count, xy=xy, battery=low), 6)
    desk.look(situation(count, xy=xy, battery=np.full(count, 0.1)), 6)
    assert len(desk.board.alarms()) == count
    low[:] = 0.9
    low[-1] = 0.1
    desk.look(situation(count, xy=xy, battery=low), 6)
    kept = desk.board.alarms()
    assert len(kept) == MOST_ALARMS
    assert f"r{count}" in {alarm.robot for alarm in kept if alarm.ended is None}


def test_a_whole_fleet_lost_at_once_is_told_in_portions_and_wholly():
    from fleet_supervisor.plugin.panel.alarms.rules import MOST_AT_ONCE

    desk = Looking()
    k = np.arange(900)
    xy = np.column_stack([k % 20 * 9.0 + 5, k // 20 * 1.4 + 5])
    all_lost = situation(900, xy=xy, state=np.full(900, LOST))
    portions = [len(desk.look(all_lost, 0.5)) for _ in range(9)]
    assert max(portions) == MOST_AT_ONCE
    assert sum(portions) == 900
    crowd = situation(40, xy=np.full((40, 2), 50.0))
    near = Looking()
    portions = [len(near.look(crowd, 0.5)) for _ in range(6)]
    assert max(portions) == MOST_AT_ONCE
    assert sum(portions) == 40 * 39 // 2
