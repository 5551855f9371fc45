"""QGIS Desktop with a crowd of robots for a short while; `make bench PARTS=endurance` is the long one."""

from __future__ import annotations

import gc
import shutil
import time
from collections.abc import Iterable

import numpy as np
import pytest

from benchmarks import endurance
from benchmarks.endurance import endure
from benchmarks.endurance_findings import (
    FLAT,
    Run,
    Sample,
    Unloaded,
    faults,
    grown,
    growth,
    kept_of_a_version,
)
from tests.support.inside_qgis.endurance.play import Player
from tests.support.inside_qgis.endurance.pulse import LATE, Pulse

ROBOTS = 20
RASTER_CACHE = 4
"""MB: less than looking at the whole site alone would fill."""


@pytest.fixture(scope="module")
def run(tmp_path_factory) -> Run:
    """Two shifts of some seconds, the plugin reloaded between them, on a network that drops every link."""
    if shutil.which("Xvfb") is None:
        pytest.skip("there is no Xvfb; run: make setup")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(endurance, "RASTER_CACHE", RASTER_CACHE)
        return endure(8.0, 1, ROBOTS, pauses=(1.0, 3.0), folder=tmp_path_factory.mktemp("endurance"))


def test_nothing_goes_wrong_and_nothing_is_left(run):
    """No exception, no warning of QGIS, and no thread, item, action, class or object after each unloading.

    Nor anything of the version before: of each class one copy may live, which Python keeps.
    """
    assert faults(run) == []
    assert len(run.unloaded) == 2


def test_what_is_to_be_endured_really_happened(run):
    assert sum(run.drops.values()) >= 2
    assert run.samples[-1].reloads >= 1
    assert run.end["told"]["warning"] >= 1


def test_rasters_that_gdal_keeps_are_bounded_and_known(run):
    rasters = [one.rasters for one in (*run.samples, *run.unloaded)]
    assert min(rasters) > 0.0
    # GDAL counts in MiB, and a block that is being read may come on top.
    assert max(rasters) <= 1.1 * RASTER_CACHE


def test_memory_that_grows_is_seen():
    samples = [Sample(10.0 * k, 500.0 + k, 200.0, 100.0, 16.0, 1000 * k, 0, 10, 2, 24, 0) for k in range(60)]
    assert growth(samples, 600.0, "megabytes") == pytest.approx((360.0, 0.0), abs=1e-6)
    assert growth(samples, 600.0, "in_use") == pytest.approx((0.0, 0.0), abs=1e-6)
    assert growth(samples, 600.0, "blocks") == pytest.approx((360_000.0, 0.0), abs=1e-3)


def test_how_well_a_growth_is_known_is_told():
    """Of twenty minutes in which pictures come and go by 20 MB, a slope is not known to ten an hour."""
    chance = np.random.default_rng(1)
    noise = chance.normal(0.0, 10.0, (100, 180))
    slopes, errors = np.array([growth(_with_in_use(row), 1800.0, "in_use") for row in noise]).T
    assert errors.mean() == pytest.approx(slopes.std(), rel=0.3)
    assert 5.0 < errors.mean() < 15.0


def test_a_growth_that_pictures_may_seem_to_be_is_no_fault():
    """Of two lines of 50 MB an hour one is known to 19 of them, the other exactly."""
    along = 50.0 / 3600 * 10.0 * np.arange(180)
    pictures = 20.0 * (-1.0) ** np.arange(180)
    hidden, plain = _with_in_use(along + pictures), _with_in_use(along)
    slope, error = growth(hidden, 1800.0, "in_use")
    assert slope - error < FLAT < slope
    assert grown(hidden, 1800.0) == []
    assert grown(plain, 1800.0) == ["what is in use grew by 50 ± 0 MB an hour, 40 at most"]


def _with_in_use(values: Iterable[float]) -> list[Sample]:
    """Samples every ten seconds, which differ in what is in use alone."""
    return [
        Sample(10.0 * k, 500.0, 200.0, float(value), 16.0, 0, 0, 10, 2, 24, 0)
        for k, value in enumerate(values)
    ]


def test_memory_that_grows_is_a_fault():
    """Each of them, and not a picture that comes and goes."""
    grow = [Sample(10.0 * k, 500.0 + k, 200.0, 100.0 + 0.2 * k, 16.0, 0, 0, 10, 2, 24, 0) for k in range(180)]
    assert grown(grow, 1800.0) == [
        "what is in use grew by 72 ± 0 MB an hour, 40 at most",
        "the process had 120 MB more at the end than at the begin, 60 at most",
    ]
    flat = [
        Sample(10.0 * k, 500.0 + 50 * (k % 7), 200.0, 100.0, 16.0, 0, 0, 10, 2, 24, 0) for k in range(180)
    ]
    assert grown(flat, 1800.0) == []
    assert len(grown(flat[:2], 1800.0)) == 2, "too few to tell"


def test_a_warm_up_does_not_count_as_growth():
    samples = [
        Sample(10.0 * k, min(500.0 + 50 * k, 700.0), 200.0, 100.0, 16.0, 0, 0, 10, 2, 24, 0)
        for k in range(60)
    ]
    assert growth(samples, 600.0, "megabytes") == pytest.approx((0.0, 0.0), abs=1e-6)


def test_whatever_is_left_is_a_fault():
    left = [[], ["1 × docks: QgsDockWidget fleet_dock"]]
    run = _ended([Unloaded(more, 100.0, 16.0, 600_000) for more in left])
    assert faults(run) == ["left after unloading: 1 × docks: QgsDockWidget fleet_dock"]


def test_pieces_that_each_reload_leaves_are_a_fault():
    run = _ended([Unloaded([], 100.0, 16.0, 600_000 + 4000 * k) for k in range(5)])
    assert faults(run) == ["each reload leaves 4,000 pieces of Python's memory, 3,000 at most"]


def test_pieces_that_stay_once_are_none():
    """As of a panel of QGIS's that is opened for the first time."""
    run = _ended([Unloaded([], 100.0, 16.0, 600_000 + 1500 * k + 50_000 * (k > 2)) for k in range(5)])
    assert kept_of_a_version(run.unloaded) == 1500
    assert faults(run) == []


def _ended(unloaded: list[Unloaded]) -> Run:
    return Run([], unloaded, {"exceptions": {}, "warnings": {}}, {}, [])


def test_a_script_that_nobody_holds_is_played_to_its_end(qgis_app, wait):
    ended, steps = [], []

    def script():
        for step in range(3):
            steps.append(step)
            yield 0.02

    Player(script(), ended.append).begin()
    wait(lambda: (gc.collect(), ended)[1], what="the script's end")
    assert (steps, ended) == ([0, 1, 2], [None])
    assert Player.under_way == []


@pytest.fixture
def pulse(qgis_app):
    """A pulse that feels, while Python collects no garbage unasked."""
    gc.collect()
    gc.disable()
    pulse = Pulse()
    pulse.go_on()
    yield pulse
    pulse.remove()
    gc.enable()


def test_a_collection_that_holds_up_the_window_is_named(pulse, wait):
    gc.collect()
    _work()
    wait(lambda: "Python's garbage collection" in pulse.gaps_at, what="a gap with a collection in it")


def test_a_collection_by_the_script_is_not_counted(pulse, wait):
    """It collects before each sample, while the pulse holds."""
    pulse.hold()
    gc.collect()
    pulse.go_on()
    _work()
    wait(lambda: pulse.gaps_at, what="a gap")
    assert "Python's garbage collection" not in pulse.gaps_at


def _work():
    until = time.thread_time() + 3 * LATE
    while time.thread_time() < until:
        continue
