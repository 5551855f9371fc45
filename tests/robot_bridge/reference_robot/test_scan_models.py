"""The filter's weights held against a slow, direct computation."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
import shapely

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.reference_robot.localisation.particle_filter import ParticleFilter
from robot_bridge.reference_robot.localisation.scan_matching import (
    BeamModel,
    FieldModel,
    PlaceSearch,
    usable_beams,
)
from robot_bridge.reference_robot.localisation.sensors import SimulatedLaser, bearings_of
from robot_bridge.reference_robot.localisation.settings import FilterSettings, LaserSettings
from robot_bridge.reference_robot.localisation.world import walls_of

LASER = LaserSettings(reach=12.0, beams=40, short=0.3, dropout=0.1)
SETTINGS = FilterSettings()
POSE = (14.5, 8.0, 0.7)


@pytest.fixture(scope="module")
def walls(yard):
    return walls_of(yard).higher_than(LASER.height)


@pytest.fixture(scope="module")
def scan(yard):
    return SimulatedLaser(walls_of(yard), LASER, np.random.default_rng(1)).scan(POSE)


@pytest.fixture(scope="module")
def poses():
    return np.array(POSE) + np.random.default_rng(2).normal(0, (1.0, 1.0, 0.5), (30, 3))


def normal(z, middle, sigma):
    return math.exp(-0.5 * ((z - middle) / sigma) ** 2) / (sigma * math.sqrt(2 * math.pi))


def directly(pose, scan, walls):
    """Return the mean logarithm of the beams' likelihood, one beam after the other."""
    lines = shapely.MultiLineString(list(np.stack([walls.a, walls.b], axis=1)))
    s, reach, logs = SETTINGS, LASER.reach, []
    for bearing, z in zip(bearings_of(LASER), scan, strict=True):
        if math.isnan(z):
            continue
        z = min(z, reach)
        x, y, angle = pose[0], pose[1], pose[2] + bearing
        ray = shapely.LineString([(x, y), (x + reach * math.cos(angle), y + reach * math.sin(angle))])
        met = shapely.intersection(ray, lines)
        expected = reach if met.is_empty else shapely.distance(met, shapely.Point(x, y))
        likelihood = s.hit * normal(z, expected, s.sigma) + s.random / reach
        if z < expected:
            likelihood += s.short / max(expected, s.sigma)
        if z >= reach:
            likelihood += s.far / s.sigma
        logs.append(math.log(likelihood / (s.hit + s.short + s.far + s.random)))
    return sum(logs) / len(logs)


def test_the_beam_model_is_the_direct_computation(walls, scan, poses):
    used = usable_beams(scan)
    assert np.isinf(scan).any() and np.isnan(scan).any()
    found, _ = BeamModel(walls, LASER, SETTINGS).log_likelihood(poses, bearings_of(LASER)[used], scan[used])
    np.testing.assert_allclose(found, [directly(pose, scan, walls) for pose in poses], atol=1e-9)


def test_the_field_is_the_likelihood_of_the_nearest_wall(walls, scan, poses):
    used = usable_beams(scan)
    bearings, ranges = bearings_of(LASER)[used], scan[used]
    found, _ = FieldModel(walls, LASER, SETTINGS).log_likelihood(poses, bearings, ranges)
    lines = shapely.MultiLineString(list(np.stack([walls.a, walls.b], axis=1)))
    s = SETTINGS
    for pose, mean in zip(poses, found, strict=True):
        logs = []
        for bearing, z in zip(bearings, ranges, strict=True):
            if z < LASER.reach:
                end = pose[0] + z * math.cos(pose[2] + bearing), pose[1] + z * math.sin(pose[2] + bearing)
                near = s.hit * normal(shapely.distance(lines, shapely.Point(end)), 0, s.sigma)
                near += (s.random + s.short) / LASER.reach
                logs.append(math.log(near / (s.hit + s.short + s.far + s.random)))
        # Cells of 0.1 m: each beam's end is up to 7 cm away from where its likelihood was reckoned.
        assert mean == pytest.approx(np.mean(logs), abs=0.25)


def test_both_models_prefer_the_place_where_the_scan_was_made(walls, scan):
    used = usable_beams(scan)
    around = np.array([POSE, *(np.array(POSE) + off for off in ((1, 0, 0), (0, 1, 0), (0, 0, 0.3)))])
    for model in (BeamModel(walls, LASER, SETTINGS), FieldModel(walls, LASER, SETTINGS)):
        assert model.log_likelihood(around, bearings_of(LASER)[used], scan[used])[0].argmax() == 0


def test_weights_after_a_scan_are_prior_times_likelihood(yard, walls, scan):
    settings = FilterSettings(least=60, most=60, beams_of_worth=2.0, sigma=SETTINGS.sigma)
    tracking = ParticleFilter(yard, LASER, settings, np.random.default_rng(3))
    # So far apart in worth that nothing is drawn anew after one scan.
    tracking.place(POSE, (0.05, 0.01))
    before = tracking.particles.copy()
    tracking.observe(scan)
    np.testing.assert_array_equal(tracking.particles, before)
    direct = np.array([math.exp(2.0 * directly(pose, scan, walls)) for pose in before])
    np.testing.assert_allclose(tracking.weights, direct / direct.sum(), rtol=1e-6)


def test_beams_without_a_reading_are_left_out():
    ranges = np.array([1.0, np.nan, np.inf, -1.0, 0.0, 5.0])
    assert usable_beams(ranges).tolist() == [0, 2, 4, 5]


ROOM = [(0, 0), (10, 0), (10, 5), (7, 5), (7, 8), (0, 8), (0, 0)]
SCREEN = [(3, 2), (3, 4)]


def drawn_in_rooms(screen, settings, seed):
    """Return how many of 400 poses are drawn in each of two equal rooms, for a scan made in the first.

    With ``screen`` there is a wall before others in the second room, which the scan did not meet.
    """
    lines = [ROOM, [(x + 20, y) for x, y in ROOM]] + ([[(x + 20, y) for x, y in SCREEN]] if screen else [])
    rows = [OutlineRow(line, ShapeType.OPEN_POLYGON, 3.0, "wall", f"w:{n}") for n, line in enumerate(lines)]
    rooms = build_map(Outlines.from_rows(rows), Window.from_bounds(0, 0, 30, 8), {"id": "rooms"})
    walls, rng = walls_of(rooms).higher_than(LASER.height), np.random.default_rng(seed)
    laser = msgspec.structs.replace(LASER, short=0.0, dropout=0.0)
    ranges = SimulatedLaser(walls, laser, rng).scan((5.0, 3.0, math.pi))
    model = BeamModel(walls, laser, settings)
    search = PlaceSearch(rooms, walls, laser, settings, model)
    x = search.likely(400, 20_000, bearings_of(laser), ranges, rng)[:, 0]
    return int((x < 15).sum()), int((x > 15).sum())


def test_a_search_draws_no_place_where_a_wall_hides_what_the_scan_met():
    here, there = drawn_in_rooms(True, SETTINGS, 1)
    assert here > 0.95 * (here + there)


def test_a_search_keeps_the_best_of_each_bin_so_that_no_place_is_left_out():
    few = msgspec.structs.replace(SETTINGS.search, kept=2, apart_m=20.0, apart_deg=360.0)
    # By one beam only: how near the two that are kept come to their places does not decide.
    settings = msgspec.structs.replace(SETTINGS, search=few, beams_of_worth=1.0)
    assert all(min(drawn_in_rooms(False, settings, seed)) > 0 for seed in range(6))
