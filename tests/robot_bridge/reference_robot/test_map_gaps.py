"""What the map lacks is told once it was seen often."""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from robot_bridge.core.messages.records import ObservationReport, ObservationState
from robot_bridge.core.messages.robots import OpAck, SendImage, SetMap, SetObject, SetPath, Stopped
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.gateway.site.site_maps import ObservedObjects
from robot_bridge.reference_robot.agent import Agent, AgentSettings
from robot_bridge.reference_robot.body import BodyLimits
from robot_bridge.reference_robot.localisation.settings import (
    FilterSettings,
    LaserSettings,
    LocalisedRobotSettings,
)
from robot_bridge.reference_robot.localisation.simulation import InlineExecutor, localised_robot

SETTINGS = LocalisedRobotSettings(
    laser=LaserSettings(reach=10.0, beams=90, short=0.1), filter=FilterSettings(least=300, most=2000)
)
PILLARS = [(17.0, 2.2, 0.3), (23.0, 5.8, 0.3), (29.0, 2.2, 0.3)]
LIMITS = BodyLimits(speed=1.0)


def circle(x, y, radius):
    around = np.linspace(0, 2 * math.pi, 25)
    return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in around]


def corridor(pillars):
    """Two plain walls 8 m apart, closed far away: how far along them it is a robot cannot see."""
    box = [(0, 0), (45, 0), (45, 8), (0, 8), (0, 0)]
    rows = [OutlineRow(box, ShapeType.OPEN_POLYGON, 3.0, "wall", "walls:1")]
    rows += [
        OutlineRow(circle(*one), ShapeType.CLOSED_POLYGON, 2.0, "pillar", f"pillars:{number}")
        for number, one in enumerate(pillars)
    ]
    return build_map(Outlines.from_rows(rows), Window.from_bounds(0, 0, 45, 8), {"id": "corridor"})


def drive(robot_map, seed=1, people=(), settings=SETTINGS):
    """Drive along the corridor with the pillars; return what was said and the error after each step."""
    pose, said, errors = (5.0, 4.0, 0.0), [], []
    body = localised_robot(corridor(PILLARS), settings, LIMITS, pose, InlineExecutor(), seed=seed)
    for walker in people:
        body._world.surroundings.add(walker, lambda walker=walker: walker(body.readings / 5))
    agent = Agent(
        AgentSettings(magic=1, pose=pose, limits=LIMITS, body=body), SimpleNamespace(say=said.append)
    )
    agent.receive(OpAck(magic=1, robot="r1"), None)
    agent.receive(SetMap(encode(robot_map)), 1)
    agent.receive(SetPath([(5.0, 4.0), (38.0, 4.0)]), 2)
    while not any(isinstance(one, Stopped) for one in said):
        agent.step(0.05)
        errors.append(math.dist(body.pose[:2], body.truth[:2]))
        assert len(errors) < 2000, (body.truth, body.hindrance, body.remark)
    return said, np.array(errors)


@pytest.fixture(scope="module")
def first():
    return drive(corridor([]))


def test_what_the_map_lacks_is_told_once_where_it_stands_with_an_image(first, tmp_path):
    objects = [one for one in first[0] if isinstance(one, SetObject)]
    assert len(objects) == len(PILLARS)
    for seen, (x, y, radius) in zip(objects, PILLARS, strict=True):
        # Its own place is known no better along the plain walls.
        assert math.dist((seen.x, seen.y), (x, y)) < 0.4
        assert seen.radius == pytest.approx(radius, abs=0.2)
    images = [one for one in first[0] if isinstance(one, SendImage)]
    assert [one.object for one in images] == [one.object for one in objects]
    (tmp_path / "seen.png").write_bytes(images[0].image)
    pixels = np.array(Image.open(tmp_path / "seen.png"))
    assert pixels.shape == (64, 64) and 5 < (pixels == 0).sum() < 300
    assert len({one.source for one in objects + images}) == 2 * len(PILLARS)


def test_who_walks_by_is_not_told_of():
    pillars = corridor(PILLARS)
    walkers = [
        lambda t: np.array([[40.0 - 0.8 * t, 2.0, 0.25]]),
        lambda t: np.array([[12.0 + 0.5 * t, 6.5, 0.25]]),
    ]
    said, _ = drive(pillars, people=walkers)
    assert not any(isinstance(one, SetObject) for one in said)


def test_what_the_map_has_and_is_not_there_is_told_of_once_by_its_name():
    gone = (20.0, 5.8, 0.3)
    moved = [(x + 0.1, y - 0.1, radius) for x, y, radius in PILLARS]
    site = corridor([*moved, gone])
    said, _ = drive(site)
    # Not what is a little beside where the map has it.
    (doubt,) = [one for one in said if isinstance(one, SetObject)]
    assert (doubt.doubts, doubt.label) == (f"pillars:{len(PILLARS)}", "pillar")
    assert math.dist((doubt.x, doubt.y), gone[:2]) < 0.05
    assert doubt.radius == pytest.approx(0.42, abs=0.02)
    told = ObservationReport(1, "r1", "SetObject", "it", doubt.x, doubt.y, 0.0, ObservationState.ACCEPTED)
    accepted = dataclasses.replace(told, radius=doubt.radius, doubts=doubt.doubts)
    left = ObservedObjects([accepted], 0.25).join(site)
    assert [one.ext["src"] for one in left.obstacles if one.semantics == "pillar"] == [
        f"pillars:{number}" for number in range(len(PILLARS))
    ]
