"""People who walk along a route: they stop before a robot, and get away from one that is upon them."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.reference_robot.localisation.avoidance import NEAREST, PERSON, People

LINE = np.array([[0.0, 0.0], [40.0, 0.0]])
ROBOT = 0.4
"""metres: its radius."""


def walk(people, robots, seconds):
    """Return each person's nearest gap to the robots at each step."""
    gaps = []
    for _ in range(int(seconds / 0.1)):
        people.step(0.1, robots)
        off = np.hypot(*(people.places[:, None, :] - robots[None, :, :2]).transpose(2, 0, 1))
        gaps.append((off - robots[None, :, 2] - PERSON).min(axis=1))
    return np.array(gaps)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_nobody_walks_into_a_robot(seed):
    people = People(6, LINE, 1.0, np.random.default_rng(seed))
    far = np.array([[20.0, 0.0, ROBOT]])
    people.places = people.places[np.hypot(*(people.places - far[0, :2]).T) > 2.0]
    people._goals = people._goals[: len(people.places)]
    gaps = walk(people, far, 120)
    assert gaps.min() >= NEAREST - 1e-9
    assert gaps.min() < 1.0, "somebody came to it"


@pytest.mark.parametrize("gap", [-0.1, 0.0, 0.1])
def test_whom_a_robot_has_come_upon_walks_away(gap):
    people = People(1, LINE, 1.0, np.random.default_rng(5))
    x, y = people.places[0]
    robot = np.array([[x, y + ROBOT + PERSON + gap, ROBOT]])
    gaps = walk(people, robot, 60)
    assert gaps.max() > 2.0


def test_without_robots_they_come_along_the_whole_line():
    people = People(1, LINE, 1.0, np.random.default_rng(7))
    seen = []
    for _ in range(6000):
        people.step(0.1, np.empty((0, 3)))
        seen.append(people.places[0, 0])
    assert max(seen) - min(seen) > 30
