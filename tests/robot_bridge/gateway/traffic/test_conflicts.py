"""Conflicts and giving way, held against a simulation in small steps of time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot_bridge.gateway.traffic import yielding
from robot_bridge.gateway.traffic.conflicts import (
    Movement,
    OtherMovements,
    conflicts_of,
    conflicts_with,
    driving_movement,
    find_conflicts,
    standing_movement,
)
from robot_bridge.gateway.traffic.yielding import yield_on_path

STEP = 0.01


def simulated(one: Movement, two: Movement, limit: float, now: float, until: float):
    """Return the spans in which the two are nearer than ``limit``, looked at every hundredth of a second."""
    times = np.arange(now, until, STEP)
    near = np.hypot(*(one.at(times) - two.at(times)).T) < limit
    edges = np.flatnonzero(np.diff(near.astype(int)))
    return times, near, times[edges + 1]


def random_movement(random, name: str, now: float) -> Movement:
    points = random.uniform(0, 30, (random.integers(2, 6), 2)).round(2)
    way = driving_movement(
        name, points, random.uniform(0.5, 3.0), now + random.uniform(0, 5), random.uniform(0.2, 1)
    )
    return way.waiting(random.uniform(0, 40), random.uniform(0, 6)) if random.random() < 0.4 else way


@pytest.mark.parametrize("seed", range(60))
def test_conflicts_are_those_of_a_simulation(seed):
    random = np.random.default_rng(seed)
    now, margin = 100.0, 0.5
    one, two = random_movement(random, "a", now), random_movement(random, "b", now)
    limit = one.radius + two.radius + margin
    found = conflicts_of(one, two, margin, now)
    last = max(one.ends, two.ends) + 3
    times, near, _ = simulated(one, two, limit, now, last)
    inside = np.zeros(len(times), bool)
    for conflict in found:
        inside |= (times >= conflict.begins) & (times <= conflict.ends)
    # They differ by a step of the simulation at each beginning and end.
    assert (inside != near).sum() <= 2 * len(found) + 2
    for conflict in found:
        during = (times >= conflict.begins) & (times <= conflict.ends)
        apart = np.hypot(*(one.at(times) - two.at(times)).T)
        if during.any():
            assert conflict.metres <= apart[during].min() + 1e-6
            assert conflict.metres == pytest.approx(apart[during].min(), abs=0.1)
            middle = (one.at([conflict.nearest_at]) + two.at([conflict.nearest_at]))[0] / 2
            assert conflict.place == pytest.approx(tuple(middle))
            assert conflict.stations[0] == pytest.approx(one.station_at(conflict.begins))


def random_fleet(seed: int) -> tuple[list[Movement], float]:
    """Robots that drive, wait, stand, begin late and end early, and a time to look from on."""
    random = np.random.default_rng(seed)
    begins = float(random.choice([0.0, 100.0, 1.7e9]))
    fleet = []
    for number in range(random.integers(1, 12)):
        if random.random() < 0.15:
            place = tuple(random.uniform(0, 60, 2))
            fleet.append(standing_movement(f"r{number}", place, begins, random.uniform(0.2, 1)))
            continue
        points = random.uniform(0, 60, (random.integers(2, 40), 2)).round(2)
        if random.random() < 0.3:
            points = np.repeat(points, 2, axis=0)
        start = begins + random.uniform(-20, 20)
        way = driving_movement(f"r{number}", points, random.uniform(0.5, 3), start, random.uniform(0.2, 1))
        waits = random.random() < 0.4
        fleet.append(way.waiting(random.uniform(0, 80), random.uniform(0, 30)) if waits else way)
    return fleet, begins + float(random.choice([0.0, 15.0, 500.0]))


@pytest.mark.parametrize("block", range(6))
def test_what_is_found_quickly_is_exactly_what_every_pair_on_its_own_has(block):
    found = 0
    for seed in range(20 * block, 20 * block + 20):
        fleet, now = random_fleet(seed)
        pairs = [(a, b) for k, a in enumerate(fleet) for b in fleet[k + 1 :]]
        each = [one for a, b in pairs for one in conflicts_of(a, b, 0.5, now)]
        quick = find_conflicts(fleet, 0.5, now)
        assert sorted(quick, key=repr) == sorted(each, key=repr), seed
        assert [one.begins for one in quick] == sorted(one.begins for one in quick)
        mine = [one for other in fleet[1:] for one in conflicts_of(fleet[0], other, 0.5, now)]
        assert sorted(conflicts_with(fleet[0], fleet[1:], 0.5, now), key=repr) == sorted(mine, key=repr)
        spans = OtherMovements(fleet[1:], 0.5, now).spans(fleet[0])
        assert sorted(spans) == sorted((one.begins, one.ends) for one in mine), seed
        found += len(each)
    assert found > 100


def test_robots_that_pass_one_place_at_other_times_are_not_looked_at_closely(monkeypatch):
    asked = set()
    times = Movement.times_around
    monkeypatch.setattr(
        Movement, "times_around", lambda self, *span: asked.add(self.robot) or times(self, *span)
    )
    east = driving_movement("east", [(0, 0), (400, 0)], 1.0, 0.0, 0.5)
    fleet = [driving_movement(f"north{k}", [(40 * k, -300), (40 * k, 100)], 1.0, 0.0, 0.5) for k in range(5)]
    met = driving_movement("met", [(300, -300), (300, 100)], 1.0, 0.0, 0.5)
    (found,) = find_conflicts([east, *fleet, met], 0.5, 0.0)
    assert {found.robot, found.other} == asked == {"east", "met"}


def test_two_on_one_lane_meet_head_on_halfway():
    east = driving_movement("a", [(0, 0), (40, 0)], 1.0, 0.0, 0.5)
    west = driving_movement("b", [(40, 0), (0, 0)], 1.0, 0.0, 0.5)
    (met,) = find_conflicts([east, west], 0.5, 0.0)
    assert (met.kind, met.place, met.metres) == ("head-on", (20.0, 0.0), pytest.approx(0.0))
    assert (met.begins, met.ends) == (pytest.approx(19.25), pytest.approx(20.75))


def test_those_who_pass_a_crossing_one_after_the_other_have_no_conflict():
    east = driving_movement("a", [(0, 0), (20, 0)], 1.0, 0.0, 0.5)
    north = driving_movement("b", [(10, -20), (10, 10)], 1.0, 0.0, 0.5)
    assert find_conflicts([east, north], 0.5, 0.0) == []
    (met,) = find_conflicts([east, driving_movement("b", [(10, -10), (10, 10)], 1.0, 0.0, 0.5)], 0.5, 0.0)
    assert (met.kind, met.place) == ("crossing", pytest.approx((10.0, 0.0)))


def test_who_stands_in_the_way_is_the_other_and_stays_for_good():
    there = standing_movement("a", (10, 0), 0.0, 0.5)
    (met,) = find_conflicts([there, driving_movement("b", [(0, 0), (10, 0)], 1.0, 0.0, 0.5)], 0.0, 0.0)
    assert (met.robot, met.other, met.kind) == ("b", "a", "standing")
    assert (met.begins, met.ends) == (pytest.approx(9.0), math.inf)


def test_a_faster_robot_that_comes_from_behind_follows():
    slow = driving_movement("a", [(10, 0), (50, 0)], 0.5, 0.0, 0.5)
    fast = driving_movement("b", [(0, 0), (50, 0)], 2.0, 0.0, 0.5)
    found = find_conflicts([slow, fast], 0.0, 0.0)
    assert found[0].kind == "following"
    assert found[0].begins == pytest.approx(6.0)


def test_two_that_stand_are_no_conflict_and_what_is_over_is_none():
    near = [standing_movement("a", (0, 0), 0.0, 1.0), standing_movement("b", (0.5, 0), 0.0, 1.0)]
    assert find_conflicts(near, 1.0, 0.0) == []
    north = driving_movement("b", [(10, -10), (10, 10)], 1.0, 0.0, 0.5)
    ways = [driving_movement("a", [(0, 0), (20, 0)], 1.0, 0.0, 0.5), north]
    assert find_conflicts(ways, 0.5, 12.0) == []


@pytest.mark.parametrize("seed", range(20))
def test_who_gives_way_meets_nobody_in_a_simulation(seed):
    random = np.random.default_rng(1000 + seed)
    now, margin = 0.0, 0.5
    others = [random_movement(random, f"o{k}", now) for k in range(3)]
    mine = driving_movement("me", random.uniform(0, 30, (4, 2)), 1.5, now, 0.5)
    wait = yield_on_path(mine, others, margin, now)
    if wait is None:
        return
    assert wait.movement.ends == pytest.approx(mine.ends + wait.seconds)
    last = max([wait.movement.ends, *(other.ends for other in others)]) + 2
    for other in others:
        _, near, _ = simulated(wait.movement, other, 0.5 + other.radius + margin - 0.02, now, last)
        assert not near.any()


def test_places_that_cannot_be_better_are_given_up_and_the_best_is_found_all_the_same(monkeypatch):
    tried, spans, places = [], OtherMovements.spans, yielding._places
    monkeypatch.setattr(
        OtherMovements, "spans", lambda self, movement: tried.append(1) or spans(self, movement)
    )
    given_up = 0
    for seed in range(1000, 1030):
        random = np.random.default_rng(seed)
        others = [random_movement(random, f"o{k}", 0.0) for k in range(3)]
        mine = driving_movement("me", random.uniform(0, 30, (4, 2)), 1.5, 0.0, 0.5)
        tried.clear()
        found, looks, best, met = yield_on_path(mine, others, 0.5, 0.0), len(tried), None, []
        tried.clear()
        with monkeypatch.context() as one_by_one:
            one_by_one.setattr(yielding, "_places", lambda at, met=met: met.append(at) or [])
            yield_on_path(mine, others, 0.5, 0.0)
            for place in places(*met) if met else [0.0]:
                one_by_one.setattr(yielding, "_places", lambda _, place=place: [place])
                wait = yield_on_path(mine, others, 0.5, 0.0)
                if wait is not None and (best is None or wait.seconds < best.seconds - 1.0):
                    best = wait
        assert (found is None) == (best is None)
        assert best is None or (found.station, found.seconds) == (best.station, best.seconds)
        given_up += len(tried) - looks
    assert given_up > 100


def test_most_random_conflicts_can_be_waited_out():
    resolved = tried = 0
    for seed in range(40):
        random = np.random.default_rng(1000 + seed)
        others = [random_movement(random, f"o{k}", 0.0) for k in range(3)]
        mine = driving_movement("me", random.uniform(0, 30, (4, 2)), 1.5, 0.0, 0.5)
        if find_conflicts([mine, others[0]], 0.5, 0.0):
            tried += 1
            resolved += yield_on_path(mine, others[:1], 0.5, 0.0) is not None
    assert tried >= 5
    assert resolved >= tried // 2


def test_the_wait_at_a_crossing_is_as_short_as_can_be_and_before_it():
    east = driving_movement("a", [(0, 0), (20, 0)], 1.0, 0.0, 0.5)
    north = driving_movement("b", [(10, -10), (10, 10)], 1.0, 0.0, 0.5)
    wait = yield_on_path(east, [north], 0.5, 0.0)
    assert wait is not None
    assert 5.0 < wait.station < 8.8
    # Who has right of way is 1.5 m beyond the crossing when the other is 1.5·√2 m short of its line.
    assert 1.5 < wait.seconds < 2.5


def test_head_on_in_a_lane_without_room_is_not_waited_out():
    east = driving_movement("a", [(0, 0), (40, 0)], 1.0, 0.0, 0.5)
    west = driving_movement("b", [(40, 0), (0, 0)], 1.0, 0.0, 0.5)
    assert yield_on_path(east, [west], 0.5, 0.0) is None


def test_nothing_in_the_way_is_no_wait():
    east = driving_movement("a", [(0, 0), (40, 0)], 1.0, 0.0, 0.5)
    wait = yield_on_path(east, [standing_movement("b", (20, 5), 0.0, 0.5)], 0.5, 0.0)
    assert (wait.movement, wait.seconds) == (east, 0.0)
