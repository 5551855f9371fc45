"""Sensors that are wrong as they are set to be, and the same for the same seed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_bridge.reference_robot.localisation.ray_casting import RayCaster
from robot_bridge.reference_robot.localisation.sensors import (
    BodyReach,
    Motion,
    SensorReading,
    SimulatedGps,
    SimulatedGyroscope,
    SimulatedLaser,
    SimulatedOdometry,
    bearings_of,
    motion_between,
    motion_fault,
    moved,
    scan_fault,
)
from robot_bridge.reference_robot.localisation.settings import (
    GpsSettings,
    GyroscopeSettings,
    LaserSettings,
    OdometrySettings,
    StandingSettings,
)
from robot_bridge.reference_robot.localisation.world import walls_of

POSE = (14.5, 8.0, 0.7)
PERFECT = {"noise": 0.0, "short": 0.0, "dropout": 0.0}
coordinate = st.floats(-1e4, 1e4)
angle = st.floats(-3.1, 3.1)


def laser(yard, seed=1, **settings):
    return SimulatedLaser(walls_of(yard), LaserSettings(**settings), np.random.default_rng(seed))


@given(coordinate, coordinate, angle, st.floats(-3, 3), st.floats(-1.5, 1.5))
def test_a_motion_is_what_leads_from_one_pose_to_the_other(x, y, theta, distance, turn):
    motion = motion_between((x, y, theta), moved((x, y, theta), Motion(distance, turn)))
    assert motion == pytest.approx((distance, turn), abs=1e-6)


def test_beams_are_spread_over_the_field():
    assert np.degrees(bearings_of(LaserSettings(beams=3, field_deg=180))) == pytest.approx([-90, 0, 90])
    assert np.degrees(bearings_of(LaserSettings(beams=4, field_deg=360))) == pytest.approx([-180, -90, 0, 90])
    assert bearings_of(LaserSettings(beams=1)) == pytest.approx([0])


def test_a_perfect_laser_tells_the_ranges_and_infinity_beyond_its_reach(yard):
    walls = walls_of(yard).higher_than(0.4)
    perfect = laser(yard, reach=6.0, **PERFECT)
    expected = RayCaster(walls.a, walls.b, 6.0).cast(np.array([POSE]), perfect.bearings)[0]
    scan = perfect.scan(POSE)
    assert 0 < np.isinf(scan).sum() < len(scan)
    np.testing.assert_allclose(np.minimum(scan, 6.0), expected)


def test_noise_short_beams_and_dropouts_are_as_many_as_set(yard):
    true = laser(yard, **PERFECT).scan(POSE)
    wrong = laser(yard, noise=0.05, short=0.3, dropout=0.1)
    scans = np.array([wrong.scan(POSE) for _ in range(200)])
    assert np.isnan(scans).mean() == pytest.approx(0.1, abs=0.01)
    off = (scans - true)[~np.isnan(scans)]
    # Of the short ones, some are short by less than the noise.
    assert (off < -0.25).mean() == pytest.approx(0.3, abs=0.03)
    assert np.std(off[np.abs(off) < 0.2]) == pytest.approx(0.05, abs=0.01)


def test_the_same_seed_makes_the_same_scans(yard):
    noisy = {"short": 0.3, "dropout": 0.1}
    first, again, other = (laser(yard, seed, **noisy).scan(POSE) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other, equal_nan=True)


def test_odometry_has_a_scale_and_a_drift_for_each_run_and_noise():
    settings = OdometrySettings(scale=0.02, drift_deg=0.5, noise=0.0, turn_noise=0.0)
    runs = [SimulatedOdometry(settings, np.random.default_rng(seed)) for seed in range(400)]
    said = np.array([run.measure(Motion(1.0, 0.0)) for run in runs])
    np.testing.assert_allclose(said, [run.measure(Motion(1.0, 0.0)) for run in runs], atol=1e-9)
    assert said.mean(axis=0) == pytest.approx((1, 0), abs=0.003)
    assert said.std(axis=0) == pytest.approx((0.02, math.radians(0.5)), rel=0.15)
    one = SimulatedOdometry(OdometrySettings(scale=0, drift_deg=0, noise=0.03), np.random.default_rng(1))
    assert np.std([one.measure(Motion(4.0, 0.0)).distance for _ in range(2000)]) == pytest.approx(
        0.06, rel=0.1
    )
    assert one.measure(Motion(0.0, 0.0)) == pytest.approx((0, 0), abs=1e-9)


def test_a_gyroscope_has_a_bias_for_each_run():
    quiet = GyroscopeSettings(bias_deg=0.1, noise_deg=0.0)
    said = [SimulatedGyroscope(quiet, np.random.default_rng(seed)).measure(0.5, 10.0) for seed in range(400)]
    assert np.mean(said) == pytest.approx(0.5, abs=0.003)
    assert np.std(said) == pytest.approx(math.radians(1.0), rel=0.15)


def test_gps_has_a_fix_in_the_open_and_none_between_walls(yard):
    gps = SimulatedGps(walls_of(yard), GpsSettings(noise=1.0), np.random.default_rng(1))
    assert gps.fix((21.0, 7.5, 0.0)) is not None  # one house beside it
    assert gps.fix((21.0, 13.5, 0.0)) is None  # in the court
    fixes = np.array([gps.fix((15.0, 8.0, 0.0)) for _ in range(400)])
    assert fixes.mean(axis=0) == pytest.approx((15, 8), abs=0.2)
    assert fixes.std(axis=0) == pytest.approx((1, 1), rel=0.15)


@pytest.mark.parametrize(
    ("t", "motion", "said"),
    [
        (10.2, Motion(0.2, 0.1), None),
        (10.2, Motion(-0.4, 0.0), None),
        (10.0, Motion(0.0, 0.0), "clock jumped by"),
        (9.8, Motion(0.2, 0.0), "clock jumped by -0.20 s"),
        (12.1, Motion(0.2, 0.0), "clock jumped by +2.10 s"),
        (math.nan, Motion(0.2, 0.0), "clock jumped by +nan s"),
        (math.inf, Motion(0.2, 0.0), "clock jumped by +inf s"),
        (10.2, Motion(0.6, 0.0), "odometry jumped by 0.60 m"),
        (10.2, Motion(0.0, -0.6), "and -0.60 rad"),
        (10.2, Motion(math.nan, 0.0), "odometry jumped by nan m"),
        (10.2, Motion(0.2, math.inf), "and inf rad"),
    ],
)
def test_time_and_motion_that_cannot_be_right_are_named(t, motion, said):
    reading = SensorReading(t, motion, np.ones(5))
    found = motion_fault(reading, 10.0, BodyReach(1.0, 1.0), StandingSettings())
    assert found is None if said is None else said in found


@pytest.mark.parametrize(
    ("ranges", "fix", "said"),
    [
        ([1.0, math.nan, math.inf], None, None),
        ([1.0, 2.0, 3.0], (1e4, -1e4), None),
        ([1.0, 2.0], None, "gives 2 ranges and not 3"),
        ([math.nan, math.nan, -1.0], None, "no beam of the laser has a reading"),
        ([1.0, 2.0, 3.0], (math.nan, 2.0), "GPS receiver gives the position (nan, 2.0)"),
        ([1.0, 2.0, 3.0], (1.0, math.inf), "GPS receiver gives the position (1.0, inf)"),
    ],
)
def test_scans_and_positions_that_cannot_be_right_are_named(ranges, fix, said):
    reading = SensorReading(10.0, Motion(0.0, 0.0), np.array(ranges), fix)
    found = scan_fault(reading, 3)
    assert found is None if said is None else said in found
