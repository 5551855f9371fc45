"""`make demo PARTS=zalazone`: what it claims really happened, and what is missing is told, not replaced."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from robot_bridge.core.sites.frame import SiteFrame
from tests.support.errors import StageError
from tests.support.processes import left_running
from tests.support.robots.ros_peer import ros_python
from tools.zalazone.places import same_ground, spellings
from tools.zalazone.recording import Sample, compare

RECORDED = {"1": np.array([(t / 10, 100.0 + t, 50.0) for t in range(60)])}


@pytest.fixture
def demo(root, tmp_path):
    """Run the demonstration: ``demo(part, **environment)``."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    kept["FLEET_ZALAZONE_FOLDER"] = str(tmp_path / "zalazone")

    def run(*part: str, **environment: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "tools.demo", *part]
        return subprocess.run(
            command,
            cwd=root,
            env=kept | environment,
            capture_output=True,
            text=True,
            timeout=900,
            check=False,
        )

    return run


@pytest.mark.again(
    "on the sample site, or on the real ground one thing at a time: test_proving_ground.py, "
    "test_linked_robots.py and test_roads.py in tests/plugin/loop, tests/plugin/map/test_way_to_the_map.py, "
    "tests/plugin/control/test_targets_from_elsewhere.py, tests/robot_bridge/links/ros2/test_ros2_live.py, "
    "tests/robot_bridge/links/replay/test_replay_live.py"
)
def test_the_whole_of_it_happens_on_the_real_proving_ground(demo, data, tmp_path):
    for package in ("cyclonedds", "rosbags"):
        pytest.importorskip(package, reason=f"{package} is not installed; run make setup")
    try:
        ros_python()
    except StageError as error:
        pytest.skip(str(error))
    done = demo("zalazone")
    assert done.returncode == 0, done.stdout + done.stderr
    for claim in (
        "six recorded cars drive",
        "cannot be commanded: ",
        "two ROS 2 robots",
        "(WGS 84, EPSG:4326) for carrier_1: reached",
        "(UTM 33N, EPSG:32633) for carrier_1: reached",
        "(EOV, EPSG:23700) for carrier_1: reached",
        "clicked on a map in WGS 84 (EPSG:4326) for carrier_1: reached",
        "clicked on a map in UTM 33N (EPSG:32633) for carrier_1: reached",
        "clicked on a map in EOV (EPSG:23700) for carrier_1: reached",
        "the 6 cones stand on one point",
        "says: Fleet Supervisor: Asphalt (drawn)",
        "carrier_2 drove the route by Nav2's FollowPath",
    ):
        assert claim in done.stdout
    folder = tmp_path / "zalazone"
    assert (folder / "steps.txt").read_text(encoding="utf-8") in done.stdout
    assert (folder / "window.png").stat().st_size > 200_000, "an empty window is a small file"
    assert not left_running(folder)


def test_an_unknown_part_is_named(demo):
    done = demo("zalazon")
    assert done.returncode == 1
    assert "there is no PARTS=zalazon; write PARTS=cluster, PARTS=zalazone, or nothing" in done.stderr


def test_missing_data_is_named(demo, tmp_path):
    done = demo("zalazone", FLEET_DATA=str(tmp_path))
    assert done.returncode == 1
    assert f"the real data is not there: {tmp_path} has no zalazone/university_track_cent" in done.stderr


def test_missing_ros_nodes_are_told_with_what_to_install_and_not_replaced(demo, data, tmp_path):
    done = demo("zalazone", PATH=str(tmp_path), XDG_CACHE_HOME=str(tmp_path / "cache"))
    assert done.returncode == 1
    assert "real rclpy nodes, and they cannot be had here" in done.stderr
    assert "apt-get install cmake g++" in done.stderr
    assert done.stdout == ""


def test_one_place_is_one_place_in_three_reference_systems():
    frame = SiteFrame("EPSG:32633", (639988.0, 5193408.4), 0.0)
    degrees, metres, eov = spellings(frame, (98.0, 262.0))
    assert (degrees.text, metres.text) == ("46.88180329, 16.83858641", "640086.00, 5193670.40")
    assert (eov.x, eov.y) == pytest.approx((481663.72, 173220.38), abs=0.05)


def test_cones_that_are_centimetres_apart_are_not_one_place():
    point, near, beside = (98.0, 262.0), (98.004, 262.0), (98.05, 262.0)
    assert same_ground([point] * 3, [point, point, near], point) == pytest.approx((0.0, 0.004, 0.004))
    for sent, placed in (
        ([point, beside], [point] * 3),
        ([point], [point, point, beside]),
        ([point], [beside] * 3),
    ):
        with pytest.raises(StageError, match="is the most"):
            same_ground(sent, placed, point)
    with pytest.raises(StageError, match="placed 2 cones there, not 3"):
        same_ground([point] * 3, [point] * 2, point)


def told(rate: float = 10.0, beside: float = 0.0, late: float = 0.0) -> dict[str, list[Sample]]:
    """Return 4 s of the car as an operator would be told it, every second place ``late``."""
    seconds = [n / rate for n in range(int(4 * rate))]
    samples = [Sample(t + late * (n % 2), 105 + 10 * t, 50 + beside) for n, t in enumerate(seconds)]
    return {"1": samples}


def test_a_replay_that_agrees_is_measured_so():
    found = compare(RECORDED, told())
    assert found.rate == pytest.approx(10.0)
    assert found.furthest == pytest.approx(0.0, abs=1e-9)
    assert found.jitter == pytest.approx(0.0, abs=1e-9)


def test_a_replay_that_is_slow_or_beside_the_line_or_late_is_measured_so():
    assert compare(RECORDED, told(rate=5.0)).rate == pytest.approx(5.0)
    assert compare(RECORDED, told(beside=0.4)).furthest == pytest.approx(0.4)
    assert compare(RECORDED, told(late=0.08)).jitter == pytest.approx(0.04, abs=1e-6)


def test_a_car_that_nobody_is_told_of_is_an_error():
    with pytest.raises(StageError, match="of car 1 only 0 places were told"):
        compare(RECORDED, {})
