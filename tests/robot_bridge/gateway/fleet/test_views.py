"""What a desk is told by its view: who is in it, nobody twice, and how many where they are too many."""

from __future__ import annotations

import asyncio
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.messages.positions import (
    MOST_ALARMED,
    MOST_CELLS,
    POSITION_TEXTS,
    AlarmLimits,
    FindRobots,
    GetPositions,
    PositionForm,
    View,
)
from robot_bridge.core.messages.robots import SendPos
from robot_bridge.core.position_frame import split_frame
from robot_bridge.gateway.fleet import views as views_module
from robot_bridge.gateway.fleet.operator_updates import position_table
from robot_bridge.gateway.fleet.views import DensityGrid, FleetViews, RowStore, ViewWatch
from robot_bridge.gateway.model.robot_columns import (
    ENDED,
    LOCATED,
    ONLY_SEEN,
    DescribedElsewhere,
    ReportedElsewhere,
)
from robot_bridge.gateway.model.robots import Robots

BOUNDS = (0.0, 0.0, 100.0, 100.0)
LIMITS = AlarmLimits(low_battery=0.2, unsure=2.0, outside=0.5)
NEAR = (0.0, 0.0, 10.0, 10.0)


class Fleet:
    """Robots by number that are driven by hand, and desks that look at them."""

    def __init__(self, **at):
        self.robots, self.clock = Robots(), ManualClock(wall=10.0)
        self.views = FleetViews(
            self.robots, SimpleNamespace(report=SimpleNamespace(bounds=BOUNDS)), self.clock
        )
        for name, (x, y) in at.items():
            self.put(name, x, y)

    def put(self, name, x, y=0.0, **more):
        if name not in self.robots:
            self.robots.ready(name, 1, "websocket", self.clock.time())
        self.robots.observe(name, SendPos(x, y, 0.0, 0.0, **more), "websocket", self.clock.time())

    def desk(self, bounds=NEAR, form=PositionForm.COLUMNS, **more):
        return Desk(self, View(bounds, **more), form)


class Desk:
    """Keeps what it is told, as the guide says."""

    def __init__(self, fleet, view, form):
        self.fleet, self.watch = fleet, ViewWatch(fleet.views, view, 5.0, form)
        self.at, self.view, self.told, self.removed = {}, None, [], []

    def show(self, bounds, **more):
        self.watch.show(View(bounds, **more))
        return self.listen()

    def listen(self, after=10.0):
        """Take in the next frame, after where everybody is was looked up again; return its params."""
        self.fleet.clock.advance(after)
        frame = self.watch.next_frame()
        if frame is None:
            self.told, self.removed = [], []
            return None
        if self.watch.form is PositionForm.ROWS:
            params = json.loads(frame)["params"]
            told = {one["robot"]: one.get("x") for one in params["robots"]}
        else:
            parts = split_frame(frame)
            params = parts.params
            x = parts.table[parts.columns.index("x")] if "x" in parts.columns else [None] * len(parts.robots)
            told = dict(zip(parts.robots, x, strict=True))
        if params.get("everything"):
            self.at = {}
        self.told, self.removed = list(told), params.get("removed", [])
        for name in [*self.removed, *params.get("untracked", [])]:
            del self.at[name]
        self.at.update(told)
        self.view = params.get("view", self.view)
        return params


def test_at_first_it_is_told_of_who_is_in_the_view_and_how_many_there_are():
    desk = Fleet(a=(1, 1), b=(50, 50), c=(10, 0)).desk()
    params = desk.listen()
    assert params["everything"] is True
    assert desk.at == {"a": 1.0, "c": 10.0}
    assert desk.view == {
        "robots": 3, "fresh": 3, "stale": 0, "lost": 0, "offline": 0, "inside": 2, "alarmed": 0,
    }  # fmt: skip


def test_robots_of_other_gateways_count_as_those_of_this_one():
    places = {"a": (1, 1), "b": (5, 5), "c": (10, 0), "d": (3, 200.0), "e": (50, 50), "f": (60, 50)}
    ours, shared = Fleet(**places), Fleet(**places)
    for name in ("f", "d", "b"):
        ours.put(name, *places[name], battery=0.1 if name == "f" else 0.9)
        shared.put(name, *places[name], battery=0.1 if name == "f" else 0.9)
        shared.robots.let_go(name, "south")
    for more in ({"alarms": LIMITS}, {"bounds": BOUNDS, "most": 1}):
        desks = [fleet.desk(**more) for fleet in (ours, shared)]
        for desk in desks:
            desk.listen()
        assert desks[0].at == desks[1].at and desks[0].view == desks[1].view
    assert {"d", "f"} <= set(shared.desk(alarms=LIMITS).show(NEAR, alarms=LIMITS)["robots"])
    there = np.array([[2.0, 1.0, 0.0, 0.0, 0.0, 0.0]], dtype="<f4")
    desk = shared.desk()
    desk.listen()
    shared.robots.observe_elsewhere(
        ReportedElsewhere(
            "south",
            1,
            np.array([0], dtype=np.uint32),
            ["b"],
            there,
            np.array([LOCATED], dtype=np.uint8),
            shared.clock.time(),
        )
    )
    desk.listen()
    assert (desk.told, desk.at["b"]) == (["b"], 2.0)


def test_then_it_is_told_of_who_has_changed_and_of_nobody_else():
    fleet = Fleet(a=(1, 1), b=(50, 50), c=(10, 0))
    desk = fleet.desk()
    desk.listen()
    assert desk.listen() is None
    fleet.put("a", 2.0)
    fleet.put("b", 51.0)
    desk.listen()
    assert (desk.told, desk.at) == (["a"], {"a": 2.0, "c": 10.0})


def test_who_leaves_the_view_is_untracked_and_not_removed():
    fleet = Fleet(a=(1, 1), b=(2, 2))
    desk = fleet.desk()
    desk.listen()
    fleet.put("a", 50.0)
    params = desk.listen()
    assert (params["untracked"], desk.removed, params["view"]["inside"]) == (["a"], [], 1)
    fleet.robots.remove("b")
    params = desk.listen()
    assert (desk.removed, params.get("untracked"), params["view"]["robots"]) == (["b"], None, 1)


def test_until_it_is_looked_up_again_who_is_in_the_view_nobody_takes_the_place_of_who_is_gone():
    fleet = Fleet(a=(1, 1), b=(2, 2))
    desk = fleet.desk()
    desk.listen()
    fleet.robots.remove("a")
    fleet.put("far", 99.0)
    fleet.put("b", 3.0)
    desk.listen(after=0.0)
    assert (desk.removed, desk.told) == (["a"], ["b"])
    # It comes back, at another gateway.
    fleet.put("a", 4.0)
    fleet.robots.let_go("a", "south")
    desk.listen(after=0.0)
    assert desk.told == ["a"]
    fleet.put("far", 98.0)
    assert desk.listen(after=0.0) is None
    assert desk.at == {"a": 4.0, "b": 3.0}


def test_another_view_tells_what_it_changes_and_nothing_twice():
    fleet = Fleet(a=(1, 1), b=(9, 9), c=(15, 15))
    desk = fleet.desk()
    desk.listen()
    params = desk.show((5.0, 5.0, 20.0, 20.0))
    assert (desk.told, params["untracked"], params.get("everything")) == (["c"], ["a"], False)
    assert set(desk.at) == {"b", "c"}


def test_another_view_is_shown_at_once_by_what_was_looked_up_before():
    fleet = Fleet(a=(1, 1), c=(15, 15))
    desk = fleet.desk()
    desk.listen()
    looked = fleet.views.places()
    desk.watch.show(View((12.0, 12.0, 20.0, 20.0)))
    assert split_frame(desk.watch.next_frame()).robots == ["c"]
    assert fleet.views.places() is looked


def test_those_asked_for_always_are_told_of_wherever_they_are():
    fleet = Fleet(a=(1, 1), b=(50, 50))
    desk = fleet.desk(always=["b", "nobody"])
    desk.listen()
    assert set(desk.at) == {"a", "b"}
    fleet.put("nobody", 77.0)
    desk.listen()
    assert desk.at["nobody"] == 77.0
    assert desk.show(NEAR)["untracked"] == ["b", "nobody"]


@pytest.mark.parametrize(
    "alarm",
    [{"battery": 0.1}, {"accuracy": 3.0}, {"x": 101.0}, "lost", "disbelieved"],
    ids=["low battery", "unsure", "outside the site", "lost", "not believed"],
)
def test_who_has_an_alarm_is_told_of_wherever_it_is(alarm):
    fleet = Fleet(well=(50, 50), far=(60, 60))
    if alarm == "lost":
        fleet.put("far", 60.0)
        fleet.clock.advance(20.0)
        fleet.put("well", 50.0)
        fleet.robots.age(fleet.clock.time())
    elif alarm == "disbelieved":
        fleet.robots.disbelieve("far", "websocket", 10.0, "a leap of 900 m")
    else:
        fleet.put("far", **{"x": 60.0, "y": 60.0, **alarm})
    desk = fleet.desk(alarms=LIMITS)
    desk.listen()
    assert (set(desk.at), desk.view["alarmed"]) == ({"far"}, 1)
    if isinstance(alarm, dict):
        assert desk.show(NEAR)["untracked"] == ["far"]


def test_of_many_with_an_alarm_the_first_are_told_and_all_are_counted():
    fleet = Fleet()
    for number in range(MOST_ALARMED + 5):
        fleet.put(f"r{number}", 50.0, battery=0.01)
    desk = fleet.desk(alarms=LIMITS)
    desk.listen()
    assert (len(desk.at), desk.view["alarmed"]) == (MOST_ALARMED, MOST_ALARMED + 5)


def test_more_in_view_than_it_wants_come_as_a_density_and_become_single_well_below():
    fleet = Fleet(**{f"r{number}": (number % 5, number // 5) for number in range(11)}, far=(90, 90))
    desk = fleet.desk(most=10, always=["r3"])
    desk.listen()
    assert set(desk.at) == {"r3"}
    density = desk.view["density"]
    assert (density["cell"], density["columns"], sum(density["fresh"]), desk.view["inside"]) == (
        1.0,
        11,
        11,
        11,
    )
    fleet.put("r0", 50.0)
    params = desk.listen()
    assert (sum(params["view"]["density"]["fresh"]), desk.told) == (10, [])
    fleet.put("r1", 50.0)
    params = desk.listen()
    assert "density" not in params["view"]
    assert len(desk.at) == 9
    fleet.put("r1", 5.0)
    fleet.put("r0", 5.0)
    params = desk.listen()
    assert (len(params["untracked"]), "density" in params["view"], set(desk.at)) == (9 - 1, True, {"r3"})


def test_desks_that_see_the_same_cells_share_one_count_of_them():
    fleet = Fleet(**{f"r{number}": (number, number) for number in range(20)})
    one, other = fleet.desk((0.0, 0.0, 99.0, 99.0), most=5), fleet.desk((0.5, 0.5, 99.5, 99.5), most=5)
    one.watch.next_frame(), other.watch.next_frame()
    assert one.watch._seen_view.density is other.watch._seen_view.density


def test_another_desk_costs_no_other_row(monkeypatch):
    fleet = Fleet(**{f"r{number}": (1, 1) for number in range(9)})
    made = []
    monkeypatch.setattr(
        views_module,
        "position_table",
        lambda robots, now: made.append(len(robots)) or position_table(robots, now),
    )
    desks = [fleet.desk() for _ in range(5)]
    for desk in desks:
        desk.watch.next_frame()
    fleet.put("r1", 2.0)
    for desk in desks:
        desk.watch.next_frame()
    assert made == [9, 1]


steps = st.lists(
    st.one_of(
        st.tuples(st.just("move"), st.integers(0, 7), st.integers(0, 12)),
        st.tuples(st.just("remove"), st.integers(0, 7), st.just(0)),
        st.tuples(st.just("show"), st.integers(0, 8), st.integers(1, 6)),
        st.tuples(st.just("listen"), st.just(0), st.just(0)),
    ),
    max_size=30,
)


@settings(deadline=None)
@given(steps, st.sampled_from([PositionForm.ROWS, PositionForm.COLUMNS]), st.integers(3, 8))
def test_whatever_happens_a_desk_knows_who_is_in_its_view_and_was_told_of_each_change_once(steps, form, most):
    fleet = Fleet()
    x_min, width = 0, 5
    desk = fleet.desk((0.0, -1.0, 5.0, 1.0), form, most=most)
    dirty = set()
    for step, number, value in [*steps, ("listen", 0, 0)]:
        if step == "move":
            fleet.put(f"r{number}", float(value))
            dirty.add(f"r{number}")
        elif step == "remove":
            fleet.robots.remove(f"r{number}")
        elif step == "show":
            x_min, width = number, value
            desk.watch.show(View((float(x_min), -1.0, float(x_min + width), 1.0), most=most))
        else:
            listen_and_compare(desk, dict(desk.at), dirty, x_min, width, most)
            dirty.clear()


def listen_and_compare(desk, knew, dirty, x_min, width, most):
    desk.listen()
    robots = desk.fleet.robots
    inside = {n: robots.pose(n).x for n in robots.names() if x_min <= robots.pose(n).x <= x_min + width}
    if desk.view.get("density"):
        assert len(inside) > most * 0.9
        inside = {}
    else:
        assert len(inside) <= most
    assert desk.at == inside
    assert set(desk.told) <= dirty | (inside.keys() - knew.keys())
    assert desk.view["robots"] == len(robots.names())


# --- densities --------------------------------------------------------------------------------------------

coordinates = st.floats(-2e3, 2e3, allow_subnormal=False) | st.sampled_from(
    [0.0, -1.0, 64.0, 512.0, float("nan")]
)


@settings(deadline=None)
@given(
    st.lists(st.tuples(coordinates, coordinates, st.integers(0, 2)), max_size=40),
    st.tuples(
        st.floats(-3e3, 3e3, allow_subnormal=False),
        st.floats(-3e3, 3e3, allow_subnormal=False),
        st.floats(0.5, 5e3),
        st.floats(0.5, 5e3),
    ),
)
def test_each_cell_counts_the_robots_in_it(robots, view):
    x_min, y_min, wide, high = view
    x, y, groups = np.array(robots, np.float64).reshape(-1, 3).T
    density = DensityGrid(x, y, groups.astype(np.intp)).over((x_min, y_min, x_min + wide, y_min + high))
    assert max(density.columns, density.rows) <= MOST_CELLS
    assert density.x <= x_min < density.x + density.cell
    assert density.y + density.rows * density.cell > y_min + high
    found = {}
    for name, values in zip(
        ("fresh", "silent", "offline"), (density.fresh, density.silent, density.offline), strict=True
    ):
        for cell, count in zip(density.cells, values, strict=True):
            if count:
                found[name, cell % density.columns, cell // density.columns] = count
    expected = {}
    for at_x, at_y, group in robots:
        column = at_x // density.cell - density.x / density.cell
        row = at_y // density.cell - density.y / density.cell
        if 0 <= column < density.columns and 0 <= row < density.rows:
            key = ("fresh", "silent", "offline")[group], int(column), int(row)
            expected[key] = expected.get(key, 0) + 1
    assert found == expected


# --- rows -------------------------------------------------------------------------------------------------


def reported_elsewhere(fleet, rng, moment):
    """Have another gateway report one of its robots: of some no place is known."""
    name, wall = f"e{rng.integers(0, 8)}", fleet.clock.time()
    kind = rng.integers(0, 8)
    if kind == 0 and name in fleet.robots and fleet.robots.gateway_of(name) == "south":
        described = DescribedElsewhere(0.25, f"status {moment}", None, 0.1, None, "targets")
        fleet.robots.describe_elsewhere(name, "south", described)
    elif kind == 1:
        fleet.put(name, float(moment))
        fleet.robots.let_go(name, "south")
    elif kind == 2:
        fleet.robots.remove(name)
    else:
        x = math.nan if kind < 5 else float(moment)
        table = np.array([[x, 1.0, 4.0, 0.25, 0.5, rng.uniform(0.0, 2.0)]], dtype="<f4")
        flags = np.array([rng.choice([LOCATED, LOCATED | ENDED, ONLY_SEEN])], dtype=np.uint8)
        number = np.array([int(name[1:])], dtype=np.uint32)
        fleet.robots.observe_elsewhere(ReportedElsewhere("south", 1, number, [name], table, flags, wall))


def test_stored_rows_say_what_a_new_table_says():
    fleet = Fleet()
    store = RowStore(fleet.robots)
    rng = np.random.default_rng(3)
    for moment in range(200):
        fleet.clock.advance(0.37)
        for number in rng.integers(0, 12, 3).tolist():
            more = {"battery": 0.5, "status": f"state {moment}"} if number % 2 else {}
            fleet.put(f"r{number}", float(moment), **more)
            fleet.robots.assign(f"r{number}", f"command-{moment}" if moment % 3 else None)
            if number % 5 == 1:
                fleet.robots.disbelieve(f"r{number}", "websocket", fleet.clock.time(), f"leap {moment}")
        for _ in range(3):
            reported_elsewhere(fleet, rng, moment)
        fleet.robots.assign("e1", f"command-{moment // 9}")
        fleet.robots.age(fleet.clock.time())
        chosen = [robot for robot in fleet.robots.changed(-1) if rng.random() < 0.6]
        now, names = fleet.clock.time(), [robot.name for robot in chosen]
        assert in_words(*store.table(names, now)) == in_words(*position_table(chosen, now))


def test_rows_of_whom_nobody_sees_any_more_are_forgotten(monkeypatch):
    monkeypatch.setattr(views_module, "SPARE", 3)
    fleet = Fleet()
    store = RowStore(fleet.robots)
    for number in range(50):
        fleet.put(f"r{number}", 1.0, status=f"state {number}")
        store.table([f"r{number}"], 0.0)
    assert len(store._rows) <= 9
    for number in range(50):
        fleet.put("r1", 1.0, status=f"more {number}")
        _, words = store.table(["r1"], 0.0)
        assert f"more {number}" in words
    assert len(store._words) <= 20


def in_words(columns, words):
    return {
        name: [None if v != v else words[int(v)] if name in POSITION_TEXTS else v for v in values.tolist()]
        for name, values in columns.items()
    }


# --- asked for once ---------------------------------------------------------------------------------------


def asked_once(fleet, view):
    result = asyncio.run(fleet.views.now(GetPositions(view))).values
    return {robot.robot for robot in result["robots"]}, result


def test_who_asks_once_is_told_what_a_desk_is_told_at_first_by_the_same_view():
    fleet = Fleet(a=(1, 1), b=(50, 50), c=(10, 0), d=(99, 99), e=(70, 70))
    fleet.put("e", 70, 70, battery=0.1)
    names, result = asked_once(fleet, View(NEAR, always=["d", "gone"], alarms=LIMITS))
    desk = fleet.desk(always=["d", "gone"], alarms=LIMITS)
    desk.listen()
    assert names == set(desk.at) == {"a", "c", "d", "e"}
    assert (result["everything"], result["view"]) == (True, desk.view)
    names, result = asked_once(fleet, View(NEAR, always=["d"], most=1))
    assert names == {"d"} and sum(result["view"]["density"].fresh) == result["view"]["inside"] == 2


def test_without_a_view_every_robot_is_told():
    names, result = asked_once(Fleet(a=(1, 1), b=(50, 50)), None)
    assert names == {"a", "b"} and "view" not in result


# --- the search -------------------------------------------------------------------------------------------


def found(fleet, **asked):
    result = asyncio.run(fleet.views.find(FindRobots(**asked))).values
    return [robot.robot for robot in result["robots"]], result["count"]


def test_robots_are_found_by_a_part_of_their_names_page_by_page():
    fleet = Fleet(**dict.fromkeys(("Cone-9", "cone-10", "van", "icon", "cone-2"), (1, 1)))
    assert found(fleet, text="CON") == (["Cone-9", "cone-10", "cone-2", "icon"], 4)
    assert found(fleet, text="con", limit=2) == (["Cone-9", "cone-10"], 4)
    assert found(fleet, text="con", limit=2, after="cone-10") == (["cone-2", "icon"], 4)
    assert found(fleet) == (["Cone-9", "cone-10", "cone-2", "icon", "van"], 5)
    assert found(fleet, text="x") == ([], 0)


def test_robots_are_found_by_their_whole_name_in_any_case():
    fleet = Fleet(**dict.fromkeys(("Cone-1", "cone-1", "cone-10", "a-cone-1"), (1, 1)))
    assert found(fleet, text="CONE-1", whole=True) == (["Cone-1", "cone-1"], 2)
    assert found(fleet, text="cone-1", whole=True, limit=1, after="Cone-1") == (["cone-1"], 2)
    assert found(fleet, text="cone", whole=True) == ([], 0)
