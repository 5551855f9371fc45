"""A robot that knows its place by its filter alone: it drives, stands when in doubt, and always obeys."""

from __future__ import annotations

import math
from concurrent.futures import Future
from dataclasses import replace
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest

from robot_bridge.core.messages.robots import (
    Abort,
    GetMap,
    GetPath,
    OpAck,
    SendPos,
    SetMap,
    SetPath,
    SetPosEnd,
    SetPosIni,
    Stopped,
)
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import PART_OF, Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.reference_robot.agent import Agent, AgentSettings
from robot_bridge.reference_robot.body import BodyLimits
from robot_bridge.reference_robot.localisation.avoidance import MovingObstacles
from robot_bridge.reference_robot.localisation.sensors import Motion
from robot_bridge.reference_robot.localisation.settings import (
    FilterSettings,
    LaserSettings,
    LocalisedRobotSettings,
    RecoverySettings,
    ReferenceRobotError,
    SearchSettings,
    WorldSettings,
)
from robot_bridge.reference_robot.localisation.simulation import MAP_MARGIN, InlineExecutor, localised_robot

DT = 0.05
LIMITS = BodyLimits(speed=1.0, acceleration=4.0)
SETTINGS = LocalisedRobotSettings(
    world=WorldSettings(moved=0.1, missing=0.5),
    laser=LaserSettings(reach=15.0, beams=60, short=0.2),
    # The yard is small, and all of it looks different: fewer places are tried, and a third of the metres
    # that are driven elsewhere show that it is at one.
    filter=FilterSettings(
        least=200,
        most=2000,
        search=SearchSettings(kept=150, tries=8),
        recovery=RecoverySettings(settled=5.0),
    ),
)
CORNER = [(13.0, 3.0), (16.0, 3.0), (16.0, 4.5)]
ROUND = [(13.0, 3.0), (16.0, 3.0), (16.0, 8.0), (13.0, 8.0), (13.0, 3.0)]


class Robot:
    """A robot in the yard, let in and with its map, and what it said."""

    def __init__(self, yard, executor=None, pose=(13.0, 3.0, 0.0), robot_map=None, settings=SETTINGS, **more):
        self.body = localised_robot(yard, settings, LIMITS, pose, executor or InlineExecutor(), **more)
        self.sent, self._ids = [], 0
        values = AgentSettings(magic=1, pose=pose, limits=LIMITS, body=self.body, map_margin=MAP_MARGIN)
        self.agent = Agent(replace(values, asks_path=True), SimpleNamespace(say=self.sent.append))
        self.agent.receive(OpAck(magic=1, robot="r1"), None)
        self.map_ack = self.tell(SetMap(encode(robot_map or yard)))

    def tell(self, message):
        self._ids += 1
        return self.agent.receive(message, self._ids)

    def live(self, seconds):
        for _ in range(round(seconds / DT)):
            self.agent.step(DT)

    def until(self, condition, seconds=120.0):
        for _ in range(round(seconds / DT)):
            if condition():
                return
            self.agent.step(DT)
        raise AssertionError(f"not within {seconds} s: {self.status}")

    def sent_of(self, kind):
        return [message for message in self.sent if isinstance(message, kind)]

    @property
    def status(self):
        return self.sent_of(SendPos)[-1].status

    @property
    def error(self):
        return math.dist(self.body.pose[:2], self.body.truth[:2])


@pytest.fixture
def robot(yard):
    return Robot(yard)


def test_it_drives_a_path_by_what_it_believes_and_says_how_sure_it_is(robot):
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.sent_of(Stopped))
    assert 14 < robot.body.driven < 18
    # The end by what it believes, and nearly so in truth; by its wheels alone it would not know.
    assert math.dist(robot.body.pose[:2], ROUND[-1]) < 0.08
    assert robot.error < 0.25
    positions = robot.sent_of(SendPos)
    assert all(0.0 < one.accuracy < 0.3 for one in positions[10:])
    assert positions[-1].status is None
    assert robot.body.clearance() > 0


def test_it_asks_for_the_path_to_a_target_and_drives_that(robot):
    robot.live(1)
    robot.tell(SetPosEnd(16.0, 8.0))
    assert robot.sent_of(GetPath)
    robot.live(2)
    assert robot.body.driven == 0.0
    robot.tell(SetPath([(13.0, 3.0), (16.0, 3.0), (16.0, 8.0)]))
    robot.until(lambda: robot.sent_of(Stopped))
    assert math.dist(robot.body.truth[:2], (16.0, 8.0)) < 0.3


def test_carried_away_it_stands_says_so_and_goes_on_once_it_is_told_where_it_is(robot):
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.body.driven > 4)
    robot.body.carry((3.0, 3.0, 1.5))
    robot.until(lambda: robot.status is not None)
    assert "does not know its place" in robot.status
    robot.until(lambda: robot.body.v == 0)
    stood = robot.body.truth
    robot.live(15)
    assert robot.body.truth == stood
    assert robot.sent_of(SendPos)[-1].accuracy >= 2.0
    assert robot.tell(SetPosIni(3.0, 3.0, 1.5)).ok
    robot.until(lambda: robot.body.hindrance is None)
    # It is not on its path any more: it asks for another one, from here.
    robot.until(lambda: robot.sent_of(GetPath))
    robot.tell(SetPath([(3.0, 3.0), (3.0, 9.0)]))
    robot.until(lambda: robot.sent_of(Stopped))
    assert math.dist(robot.body.truth[:2], (3.0, 9.0)) < 0.3


def test_with_its_laser_covered_for_a_while_it_stands_and_then_goes_on(robot):
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.live(2)
    measured = robot.body.measured
    robot.body.measured = lambda reading: replace(reading, ranges=np.full_like(reading.ranges, np.nan))
    robot.until(lambda: robot.status is not None and robot.body.v == 0)
    assert "no beam of the laser has a reading" in robot.status
    stood = robot.body.truth
    robot.live(3)
    assert robot.body.truth == stood
    robot.body.measured = measured
    robot.until(lambda: robot.sent_of(Stopped))
    assert robot.error < 0.25


FAULTS = {
    "the odometry jumped by 5": lambda r: replace(r, motion=Motion(r.motion.distance + 5.0, r.motion.turn)),
    "the odometry jumped by nan": lambda r: replace(r, motion=Motion(math.nan, 0.0)),
    "sensors' clock jumped by": lambda r: replace(r, t=r.t - 3600.0),
    "the GPS receiver gives the position (nan, 3.0)": lambda r: replace(r, fix=(math.nan, 3.0)),
    "gives 3 ranges and not 60": lambda r: replace(r, ranges=np.ones(3)),
}


@pytest.mark.parametrize("said", FAULTS)
def test_a_reading_that_cannot_be_right_makes_it_stand_and_say_why(robot, said):
    robot.live(1)
    robot.tell(SetPath(CORNER))
    robot.live(2)
    measured, seen = robot.body.measured, []

    def fail_once(reading):
        seen.append(reading)
        return FAULTS[said](reading) if len(seen) == 1 else reading

    robot.body.measured = fail_once
    robot.until(lambda: seen)
    assert said in robot.body.hindrance
    robot.agent.step(DT)
    assert robot.body.v < 1.0
    robot.body.measured = measured
    # Where it expects to be its scans fit: it finds itself, and goes on.
    robot.until(lambda: robot.sent_of(Stopped))
    assert robot.error < 0.25 and robot.body.driven < 6


def test_a_map_of_another_site_is_refused_and_the_old_one_kept(robot, yard):
    robot.live(1)
    elsewhere = build_map(Outlines.from_rows([]), Window.from_bounds(0, 0, 30, 20), {"crs": "EPSG:25831"})
    ack = robot.tell(SetMap(encode(elsewhere)))
    assert not ack.ok and "its crs is EPSG:25831" in ack.reason and "another" in ack.reason
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.sent_of(Stopped))
    assert robot.error < 0.25


def test_a_map_with_nothing_to_see_or_of_elsewhere_is_refused_and_it_stands_without_one(yard):
    empty = build_map(Outlines.from_rows([]), Window.from_bounds(0, 0, 30, 20), {"id": "moor"})
    robot = Robot(yard, robot_map=empty)
    assert not robot.map_ack.ok and "nothing on it is higher than the laser" in robot.map_ack.reason
    robot.tell(SetPath(ROUND))
    robot.live(3)
    assert robot.body.driven == 0 and "it has no map yet" in robot.status
    asked = robot.sent_of(GetMap)[0]
    assert (asked.x, asked.y) == (13.0, 3.0)
    part = build_map(Outlines.from_rows([]), Window.from_bounds(20, 10, 30, 20), {"id": "yard"})
    assert "is higher" in robot.tell(SetMap(encode(part))).reason
    assert robot.tell(SetMap(encode(yard))).ok
    robot.until(lambda: robot.sent_of(Stopped))


def test_where_its_laser_reaches_nothing_of_the_map_it_stands_and_says_so(yard):
    settings = msgspec.structs.replace(SETTINGS, laser=LaserSettings(reach=2.0, beams=60))
    robot = Robot(yard, pose=(15.0, 8.5, 0.0), settings=settings)
    robot.tell(SetPath([(15.0, 8.5), (15.0, 2.0)]))
    robot.live(4)
    assert robot.body.driven == 0 and "nothing of its map is within the reach" in robot.status


def test_a_map_that_is_not_the_one_of_where_it_drives_is_noticed_by_its_scans(yard):
    # The same walls, turned by half and moved: all is somewhere else.
    turned = replace(
        yard,
        obstacles=tuple(
            replace(one, a=(31.0, 23.0) - one.a, b=(31.0, 23.0) - one.b) for one in yard.obstacles
        ),
    )
    robot = Robot(yard, robot_map=turned)
    robot.tell(SetPath(ROUND))
    robot.live(20)
    assert "does not know its place" in robot.status
    assert robot.body.driven < 3


def window(yard, x, side):
    """Return the part of the yard around x, with its walls as they are."""
    border = replace(yard).border._replace(x_min=x - side / 2, x_max=x + side / 2)
    return replace(yard, border=border, meta={**yard.meta, PART_OF: "0,0,30,20"})


def test_near_the_border_of_its_map_it_asks_for_the_next_and_waits_there_until_it_has_it(yard):
    robot = Robot(yard, pose=(10.0, 17.0, 0.0), robot_map=window(yard, 10.0, 16.0))
    robot.live(1)
    assert not robot.sent_of(GetMap)
    robot.tell(SetPath([(10.0, 17.0), (27.0, 17.0)]))
    robot.until(lambda: robot.sent_of(GetMap))
    assert robot.body.truth[0] < 16.1
    # It is late, and then one of elsewhere comes: no harm is done.
    robot.live(15)
    assert robot.body.v == 0 and robot.body.truth[0] < 17.0
    assert "at the border of its map" in robot.status
    assert not robot.tell(SetMap(encode(window(yard, 25.0, 8.0)))).ok
    assert len(robot.sent_of(GetMap)) >= 4
    asked = robot.sent_of(GetMap)[-1]
    assert math.dist((asked.x, asked.y), robot.body.truth[:2]) < 0.3
    assert robot.tell(SetMap(encode(window(yard, 20.0, 20.0)))).ok
    robot.until(lambda: robot.sent_of(Stopped))
    assert robot.error < 0.25


def test_it_asks_for_the_next_map_20_m_before_the_border_of_its_own(yard):
    assert MAP_MARGIN == 20.0
    # Which ends at x = 24 m; a quarter of its shorter side before it would be x = 19 m.
    robot = Robot(yard, pose=(10.0, 17.0, 0.0), robot_map=window(yard, 10.0, 28.0))
    robot.live(1)
    robot.tell(SetPath([(10.0, 17.0), (18.0, 17.0)]))
    # Not before it has come 5 m from where it was sent this one.
    robot.until(lambda: robot.sent_of(GetMap))
    assert 14.8 < robot.body.truth[0] < 15.5


class HeldExecutor(InlineExecutor):
    """Works at once until it is held: then it is busy with the first thing that it is asked."""

    def __init__(self):
        self.held, self._waiting = False, None

    def submit(self, fn, /, *args, **kwargs):
        if not self.held:
            return super().submit(fn, *args, **kwargs)
        assert self._waiting is None, "one after the other"
        future = Future()
        self._waiting = future, lambda: fn(*args, **kwargs)
        return future

    def release(self):
        self.held = False
        future, work = self._waiting
        future.set_result(work())


@pytest.mark.parametrize("order", [Abort(), Abort(emergency=True)])
def test_an_abort_stops_it_at_once_though_the_filter_is_busy(yard, order):
    executor = HeldExecutor()
    robot = Robot(yard, executor)
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.body.v > 0.7)
    executor.held = True
    robot.live(0.2)
    assert robot.body.v > 0.15
    robot.tell(order)
    # Before it notices by itself that the filter is late.
    robot.live(0.5)
    assert robot.body.v == 0 and robot.body.hindrance is None


def test_a_busy_filter_makes_it_stand_and_it_goes_on_when_that_has_come_after(yard):
    executor = HeldExecutor()
    robot = Robot(yard, executor)
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.body.v > 0.7)
    executor.held = True
    robot.live(2.5)
    assert "behind the sensors" in robot.status and robot.body.v == 0
    # What it drove meanwhile is known all the same.
    assert robot.error < 0.2
    executor.release()
    robot.until(lambda: robot.sent_of(Stopped))
    assert robot.error < 0.25


def test_a_filter_that_fails_makes_it_stand_and_abort_is_obeyed(robot):
    robot.live(1)
    robot.tell(SetPath(ROUND))
    robot.live(2)

    def fail(*_):
        raise ReferenceRobotError("the particles are gone")

    tracked, robot.body.localiser._update = robot.body.localiser._update, fail
    robot.until(lambda: robot.body.v == 0)
    assert "localisation failed: the particles are gone" in robot.status
    assert robot.tell(Abort()).ok
    robot.body.localiser._update = tracked
    stood = robot.body.truth
    robot.until(lambda: robot.body.hindrance is None)
    robot.live(2)
    assert robot.body.truth == stood


class Visitor:
    """Somebody who stands in the way, and may leave."""

    def __init__(self, *place):
        self.discs = np.array([[*place, 0.25]])


def test_it_waits_for_somebody_in_its_way_and_goes_on_when_they_leave(robot):
    robot.live(1)
    visitor = Visitor(16.0, 5.0)
    robot.body._world.surroundings.add(visitor, lambda: visitor.discs)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.status is not None)
    assert "something is in its way" in robot.status
    assert robot.body.clearance() > 0.1 and robot.body.v == 0
    visitor.discs = visitor.discs[:0]
    robot.until(lambda: robot.sent_of(Stopped), 30)


def test_it_goes_round_what_stays(robot):
    robot.live(1)
    visitor, nearest = Visitor(16.0, 5.0), []
    robot.body._world.surroundings.add(visitor, lambda: visitor.discs)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: nearest.append(robot.body.clearance()) or robot.sent_of(Stopped))
    assert min(nearest) > 0.0


def test_it_asks_for_another_path_when_its_way_stays_blocked(robot):
    robot.live(1)
    # Wider than it goes round, not all across the yard: so much of the map hidden, it would be lost.
    crowd = [Visitor(x, 4.5) for x in np.arange(12.5, 20.0, 0.5)]
    for one in crowd:
        robot.body._world.surroundings.add(one, lambda one=one: one.discs)
    robot.tell(SetPath(ROUND))
    robot.until(lambda: robot.sent_of(GetPath), 30)
    assert robot.body.clearance() > 0


def test_nobody_sees_itself():
    around = MovingObstacles()
    one, other = object(), object()
    around.add(one, lambda: np.array([[1.0, 2.0, 0.3]]))
    around.add(other, lambda: np.array([[5.0, 6.0, 0.3]]))
    assert around.around(one).tolist() == [[5.0, 6.0, 0.3]]


def test_a_place_in_a_wall_is_refused(yard):
    with pytest.raises(
        ReferenceRobotError, match=r"pose \(8\.0, 7\.0\) is not on the map of world yard, or in"
    ):
        Robot(yard, pose=(8.0, 7.0, 0.0))
