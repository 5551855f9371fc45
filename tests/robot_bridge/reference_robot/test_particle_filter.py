"""The filter in a yard: it tracks, says how sure it is, finds itself again, and finds itself from nothing."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.reference_robot.localisation.particle_filter import ParticleFilter
from robot_bridge.reference_robot.localisation.sensors import (
    Motion,
    SimulatedLaser,
    SimulatedOdometry,
    motion_between,
)
from robot_bridge.reference_robot.localisation.settings import (
    FilterSettings,
    LaserSettings,
    OdometrySettings,
    ReferenceRobotError,
    SearchSettings,
    WorldSettings,
)
from robot_bridge.reference_robot.localisation.world import changed, walls_of

LASER = LaserSettings(reach=15.0, beams=60, short=0.3)
# The yard is small: where the robot may be is found among fewer places, tried less often around.
SETTINGS = FilterSettings(least=300, most=3000, search=SearchSettings(kept=150, tries=8))
CIRCLE = [
    (14.5 + 3.5 * math.sin(s), 6.0 - 2.5 * math.cos(s), math.atan2(2.5 * math.sin(s), 3.5 * math.cos(s)))
    for s in np.linspace(0, 2 * math.pi, 60)
]
"""Round the yard's middle."""


class Run:
    """A robot on a path of poses in a world that differs from the map."""

    def __init__(self, yard, seed=1, settings=SETTINGS):
        rng = np.random.default_rng(seed)
        seen = walls_of(yard).higher_than(LASER.height)
        self.laser = SimulatedLaser(changed(seen, WorldSettings(moved=0.1, missing=0.5), rng), LASER, rng)
        self.wheels = SimulatedOdometry(OdometrySettings(), rng)
        self.filter = ParticleFilter(yard, LASER, settings, np.random.default_rng(seed))

    def drive(self, path):
        """Yield the error in metres and radians after each pose."""
        before = path[0]
        for pose in path:
            self.filter.move(self.wheels.measure(motion_between(before, pose)))
            self.filter.observe(self.laser.scan(pose))
            before = pose
            x, y, theta = self.filter.belief.pose
            yield math.dist((x, y), pose[:2]), abs(math.remainder(theta - pose[2], math.tau))


@pytest.mark.parametrize("model", ["beam", "field"])
def test_it_tracks_in_a_world_that_differs_from_the_map(yard, model):
    run = Run(yard, settings=FilterSettings(model=model, least=300, most=3000))
    run.filter.place(CIRCLE[0], (0.1, 0.05))
    away, turned = np.array(list(run.drive(CIRCLE))).T
    assert away.max() < 0.3 and away.mean() < 0.1
    assert np.degrees(turned).mean() < 1.0
    belief = run.filter.belief
    assert belief.share > 0.99
    assert 0.003 < belief.accuracy < 0.15


def test_the_belief_is_mean_and_covariance_of_the_particles(yard):
    run = Run(yard)
    run.filter.place((14.5, 3.5, math.pi), (0.2, 0.1))
    cloud = run.filter.particles
    belief = run.filter.belief
    # Across the turn of π: no mean of angles near +π and −π that is 0.
    assert belief.pose[:2] == pytest.approx(cloud[:, :2].mean(axis=0), abs=1e-6)
    assert abs(math.remainder(belief.pose[2] - cloud[:, 2].mean(), math.tau)) < 1e-3
    np.testing.assert_allclose(belief.covariance, np.cov(cloud.T, bias=True), atol=1e-3)
    assert belief.accuracy == pytest.approx(0.2, rel=0.15)


def test_motion_spreads_the_particles_and_moves_their_mean(yard):
    tracking = Run(yard).filter
    tracking.place((5.0, 3.0, 0.0), (0.0, 0.0))
    for _ in range(10):
        tracking.move(Motion(0.5, math.radians(9)))
    x, y, theta = tracking.belief.pose
    # Ten chords of an arc of 90° that is 5 m long.
    radius = 5.0 / (math.pi / 2)
    assert (x, y) == pytest.approx((5 + radius, 3 + radius), abs=0.05)
    assert theta == pytest.approx(math.pi / 2, abs=0.01)
    assert 0.02 < tracking.belief.accuracy < 0.3


def test_it_finds_itself_after_it_was_carried_away(yard):
    run = Run(yard)
    run.filter.place(CIRCLE[0], (0.1, 0.05))
    assert max(away for away, _ in run.drive(CIRCLE)) < 0.3
    elsewhere = [(3.0, 2.0 + 0.2 * k, math.pi / 2) for k in range(60)]
    away = [away for away, _ in run.drive(elsewhere)]
    assert away[0] > 5
    assert max(away[-10:]) < 0.3


def test_it_finds_itself_from_nothing(yard):
    run = Run(yard, seed=2)
    run.filter.search(run.laser.scan(CIRCLE[0]))
    assert len(run.filter.particles) == SETTINGS.most
    away = [away for away, _ in run.drive(CIRCLE)]
    assert max(away[-10:]) < 0.3
    assert len(run.filter.particles) < SETTINGS.most / 2


def test_a_gps_position_weighs_particles_by_their_distance_and_rules_none_out(yard):
    tracking = Run(yard).filter
    tracking.place(CIRCLE[0], (1.0, 0.1))
    tracking.observe_fix(15.0, 5.0, 1.5)
    away = np.hypot(*(tracking.particles[:, :2] - (15.0, 5.0)).T)
    direct = np.array([math.exp(-(metres**2) / (2 * 1.5**2)) + SETTINGS.gps.wrong for metres in away])
    np.testing.assert_allclose(tracking.weights, direct / direct.sum())
    assert not tracking.belief.lost


def test_a_gps_position_that_is_no_number_is_refused_and_changes_nothing(yard):
    tracking = Run(yard).filter
    tracking.place(CIRCLE[0], (0.1, 0.05))
    before = tracking.weights.copy()
    for x, y in ((math.nan, 3.5), (14.5, math.inf)):
        with pytest.raises(ReferenceRobotError, match=r"GPS position .* is not finite"):
            tracking.observe_fix(x, y, 1.5)
    np.testing.assert_array_equal(tracking.weights, before)


def test_gps_positions_far_from_the_belief_bring_it_back(yard):
    run = Run(yard)
    run.filter.place((3.0, 18.0, 0.0), (0.1, 0.05))
    # Two of three: one that is right by chance, or one that is wrong, says nothing.
    for fix, told in (((14.5, 3.5), False), ((3.0, 17.0), False), ((14.5, 3.5), True)):
        run.filter.observe_fix(*fix, 1.0)
        assert run.filter.belief.lost == told
    run.filter.observe(run.laser.scan(CIRCLE[0]))
    away = [away for away, _ in run.drive(CIRCLE[:12])]
    assert away[-1] < 0.3


def drive_to_and_fro(run, pose, metres):
    for _ in range(metres):
        run.filter.move(Motion(0.5, 0.0))
        run.filter.move(Motion(-0.5, 0.0))
        run.filter.observe(run.laser.scan(pose))


def test_what_it_drove_at_another_place_does_not_count_towards_this_one(yard):
    run, there = Run(yard), (3.0, 3.0, math.pi / 2)
    run.filter.place(CIRCLE[0], (0.1, 0.05))
    run.filter.doubt()
    drive_to_and_fro(run, CIRCLE[0], 12)
    run.filter.particles = run.filter.particles + np.subtract(there, CIRCLE[0])
    drive_to_and_fro(run, there, 12)
    assert run.filter.belief.lost
    drive_to_and_fro(run, there, 8)
    assert not run.filter.belief.lost


# The second: most likely at one place, and another that fits has kept a tenth of the weight.
@pytest.mark.parametrize("every", [2, 10])
def test_what_it_drives_while_it_may_be_in_two_places_does_not_count(yard, every):
    run = Run(yard)
    run.filter.place(CIRCLE[0], (0.1, 0.05))
    run.filter.doubt()
    together = run.filter.particles
    apart = together.copy()
    apart[::every, 0] += 5.0
    run.filter.particles = apart
    one_beam = np.full(LASER.beams, np.nan)
    one_beam[0] = 2.0
    run.filter.observe(one_beam)
    run.filter.move(Motion(20.0, 0.0))
    run.filter.settle(20.0)
    run.filter.particles, run.filter.weights = together, np.full(len(together), 1 / len(together))
    assert run.filter.belief.lost


def along_a_corridor(wheels, seed, settings=SETTINGS, end=140):
    """Drive 60 m between two plain walls, closed at ``end``; return errors, accuracy and beliefs."""
    walls = [(-60, 0), (end, 0), (end, 4), (-60, 4)]
    rows = [OutlineRow(walls, ShapeType.OPEN_POLYGON, 3.0, "wall", "walls:1")]
    corridor = build_map(Outlines.from_rows(rows), Window.from_bounds(-60, -1, 140, 5), {"id": "corridor"})
    run, path = Run(corridor, seed, settings), [(0.4 * k, 2.0, 0.0) for k in range(150)]
    run.wheels = SimulatedOdometry(wheels, np.random.default_rng(seed))
    run.filter.place(path[0], (0.05, 0.02))
    errors, beliefs = [], []
    for away, _ in run.drive(path):
        errors.append(away)
        beliefs.append(run.filter.belief)
    return np.array(errors), np.array([one.accuracy for one in beliefs]), beliefs


SEEDS = pytest.mark.parametrize(
    "seeds", [(1, 2), pytest.param((3, 4), marks=pytest.mark.again("seeds 1, 2"))]
)


@SEEDS
def test_between_plain_walls_its_accuracy_grows_along_them_and_covers_what_it_is_off(seeds):
    # Wheels that are wrong by 1 % all along, as a standard deviation, and nothing that shows it.
    drives = [along_a_corridor(OdometrySettings(drift_deg=0.0), seed) for seed in seeds]
    for errors, accuracy, beliefs in drives:
        assert accuracy[-1] > 0.4 and accuracy[-1] > 2 * accuracy[len(accuracy) // 4]
        along, across = np.sqrt(np.diag(beliefs[-1].covariance)[:2])
        assert along > 0.4 and across < 0.12
        assert not beliefs[-1].lost
        assert (errors < 3 * accuracy + 0.1).all()
    within = np.concatenate([errors <= 2 * accuracy for errors, accuracy, _ in drives])
    assert within.mean() >= 0.95


def test_the_end_of_a_corridor_tells_how_far_it_came():
    errors, accuracy, _ = along_a_corridor(OdometrySettings(drift_deg=0.0), 3, end=66)
    assert accuracy.max() > 0.4 and errors.max() > 0.5
    assert accuracy[-1] < 0.2 and errors[-1] <= 2 * accuracy[-1]


def test_of_wheels_that_may_be_very_wrong_between_plain_walls_it_says_in_time_that_it_is_lost():
    settings = msgspec.structs.replace(SETTINGS, wheel_scale=0.05)
    _, accuracy, beliefs = along_a_corridor(OdometrySettings(drift_deg=0.0), 1, settings=settings)
    told = [belief.lost for belief in beliefs]
    assert not any(told[: len(told) // 3]) and all(told[-10:])
    assert accuracy[told.index(True)] == pytest.approx(SETTINGS.standing.lost_accuracy, abs=0.1)


def test_another_map_of_the_same_frame_changes_nothing_of_the_belief(yard):
    run = Run(yard)
    run.filter.place(CIRCLE[0], (0.1, 0.05))
    list(run.drive(CIRCLE[:10]))
    before = run.filter.belief.pose
    run.filter.use_map(yard)
    assert run.filter.belief.pose == before


def test_the_same_seed_makes_the_same_belief(yard):
    runs = [Run(yard, seed=4), Run(yard, seed=4)]
    for run in runs:
        run.filter.place(CIRCLE[0], (0.1, 0.05))
    first, again = (list(run.drive(CIRCLE[:8])) for run in runs)
    assert first == again


def test_a_map_with_nothing_to_see_is_refused(yard):
    empty = build_map(Outlines.from_rows([]), Window.from_bounds(0, 0, 9, 9), {"id": "moor"})
    with pytest.raises(ReferenceRobotError, match="map moor: nothing on it is higher than the laser"):
        ParticleFilter(empty, LASER, SETTINGS, np.random.default_rng(1))


def test_a_scan_of_another_laser_is_refused_and_an_empty_one_changes_nothing(yard):
    tracking = Run(yard).filter
    tracking.place(CIRCLE[0], (0.1, 0.05))
    before = tracking.weights.copy()
    tracking.observe(np.full(LASER.beams, np.nan))
    np.testing.assert_array_equal(tracking.weights, before)
    with pytest.raises(ReferenceRobotError, match=r"ranges for 60 beams"):
        tracking.observe(np.ones(59))
