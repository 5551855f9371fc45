"""The experiments: what they are set to, what they measure, and the command that runs them."""

from __future__ import annotations

import csv
import math
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import msgspec
import numpy as np
import pytest
from typer.testing import CliRunner

from robot_bridge.__main__ import command_line
from robot_bridge.reference_robot.localisation import experiment
from robot_bridge.reference_robot.localisation.experiment import Carried, ExperimentSettings, Record
from robot_bridge.reference_robot.localisation.experiment_report import csv_text, figures, table_text
from robot_bridge.reference_robot.localisation.settings import (
    FilterSettings,
    LaserSettings,
    ReferenceRobotError,
    WorldSettings,
)

ROUND = ExperimentSettings(
    title="Round the middle",
    route=[(13.0, 3.0), (16.0, 3.0), (16.0, 8.0), (13.0, 8.0), (13.0, 3.0)],
    world=WorldSettings(moved=0.1, missing=0.5),
    laser=LaserSettings(reach=15.0, beams=60, short=0.3),
    filter=FilterSettings(least=300, most=3000),
)


@pytest.fixture(scope="module")
def drive(yard):
    return experiment.run(yard, ROUND, seed=1)


def changed(**settings):
    return msgspec.structs.replace(ROUND, **settings)


def test_a_robot_steered_by_its_belief_comes_round(drive):
    (row,) = figures([drive])
    assert row.driven_m > 14  # its corners are rounded
    assert math.dist(drive.truth[-1, :2], ROUND.route[-1]) < 0.4
    assert (row.lost, row.wrong, row.found_m) == (0, 0, 0.0)
    assert row.mean_m < 0.12 and row.max_m < 0.35 and row.heading_mean_deg < 1.0


def test_the_same_seed_makes_the_same_drive_and_another_one_another(yard, drive):
    short = changed(length=3.0)
    first, again, other = (experiment.run(yard, short, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.belief, again.belief)
    assert not np.array_equal(first.belief[:5], other.belief[:5])
    assert first.driven[-1] == pytest.approx(3.0, abs=0.3)


def test_a_robot_that_was_carried_away_says_that_it_is_lost_and_finds_itself(yard):
    settings = changed(carried=Carried(after=1.5, by=4.0), steered_by="truth")
    record = experiment.run(yard, settings, seed=3)
    step = np.hypot(*np.diff(record.truth[:, :2], axis=0).T)
    assert int(step.argmax()) + 1 == record.carried and step.max() > 2
    # The wheels have not noticed.
    assert np.hypot(*np.diff(record.odometry[:, :2], axis=0).T).max() < 0.4
    assert not record.lost[: record.carried].any()
    assert record.lost[record.carried :].any()
    assert figures([record])[0].found_m < 7.0


def test_a_robot_that_knows_nothing_is_lost_at_first(yard):
    record = experiment.run(yard, changed(start="unknown", length=10.0, steered_by="truth"), seed=2)
    assert record.lost[0]
    assert figures([record])[0].found_m < 8.0


def test_figures_are_those_of_the_scans_at_which_it_does_not_say_that_it_is_lost():
    truth = np.zeros((4, 3))
    belief = np.array([[0.1, 0, 0.02], [0, 0.3, -0.04], [50, 0, 3], [2, 0, 2 * np.pi]])
    record = Record(
        seed=5, carried=1, truth=truth, odometry=np.full((4, 3), (3, 4, 0)), belief=belief,
        driven=np.array([1.0, 2, 3, 4]), accuracy=np.array([0.05, 0.1, 1, 1]),
        lost=np.array([False, False, True, False]),
        seconds=np.array([0.001, 0.002, 0.003, 0.004]), particles=np.full(4, 500),
    )  # fmt: skip
    (row,) = figures([record])
    assert row.mean_m == pytest.approx((0.1 + 0.3 + 2) / 3)
    assert row.max_m == 2 and row.lost == 1 and row.wrong == 1
    # 0.1 m at an accuracy of 0.05 m and 2 m at one of 1 m, but not 0.3 m at one of 0.1 m.
    assert row.within == pytest.approx(2 / 3)
    turned = np.degrees([0.02, 0.04, 0.0])
    assert row.heading_mean_deg == pytest.approx(turned.mean())
    assert row.heading_p95_deg == pytest.approx(np.percentile(turned, 95))
    assert row.heading_max_deg == pytest.approx(turned.max())
    assert row.odometry_end_m == 5 and row.update_ms == pytest.approx(2.5)
    assert row.found_m == math.inf
    assert "| – |" in table_text([row])
    rows = figures([record, record])
    assert [one.seed for one in rows] == ["5", "5", "all"]
    (head, *lines) = csv.reader(csv_text(rows).splitlines())
    assert head[0] == "seed" and [line[0] for line in lines] == ["5", "5", "all"]


@pytest.mark.parametrize("name", experiment.names())
def test_the_settings_that_come_with_the_program_can_be_read(name):
    settings = experiment.read_settings(experiment.EXPERIMENTS / f"{name}.toml")
    assert settings.title and len(settings.route) > 2
    # What the paper's campus is made of stands here alone: the filter is as for any other.
    assert settings.filter == FilterSettings()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("route = [[0, 0]]", r"\$\.route"),
        ("route = [[0, 0], [1, 1]]\n[laser]\nbeams = 0", r"\$\.laser\.beams"),
        ("route = [[0, 0], [1, 1]]\n[filter]\nsigmas = 1", "sigmas"),
        ("route = [[0, 0], [1, 1]]\n[filter.gps]\nagainst = 4", "against = 4 is more than of = 3"),
        ("route = [[0, 0], [1, inf]]", "route"),
        ("route = ", "no TOML"),
        ("#" * 70_000, "more than 64000"),
        # What tomllib alone takes seconds for.
        ("a" + ".a" * 30_000 + " = 1", "more than 32 parts"),
        ("route = " + "[" * 30_000, "nested too deeply"),
    ],
)
def test_wrong_settings_are_named(tmp_path, text, said):
    file = tmp_path / "mine.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ReferenceRobotError, match=rf"mine\.toml.*{said}"):
        experiment.read_settings(file)


@pytest.mark.parametrize(("x", "y"), [(31.0, 3.0), (8.0, 7.0)])
def test_a_route_beside_the_map_or_through_a_house_is_refused(yard, x, y):
    with pytest.raises(ReferenceRobotError, match=r"route: .* is not on map yard, or in something solid"):
        experiment.run(yard, changed(route=[(13.0, 3.0), (x, y)]), seed=1)


def test_the_command_prints_the_table_and_writes_plots(root, tmp_path):
    settings = tmp_path / "campus.toml"
    settings.write_text(
        'title = "Between the houses"\nroute = [[20, 20], [26, 20]]\n[filter]\nleast = 200\n',
        encoding="utf-8",
    )
    program = Path(sys.executable).with_name("robot-bridge")
    words = ["experiment", str(settings), "--site", "resources/sample_site", "--seeds", "1"]
    done = subprocess.run(
        [program, *words, "--output", str(tmp_path / "out")],
        cwd=root,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert re.search(r"^\| 1 \| 5\.\d \| 0\.\d", done.stdout, re.MULTILINE)
    assert {file.name for file in (tmp_path / "out").iterdir()} == {
        "campus.csv",
        "campus-1.svg",
    }
    drawn = ElementTree.parse(tmp_path / "out" / "campus-1.svg").getroot()
    lines = [one.get("stroke") for one in drawn.iter("{http://www.w3.org/2000/svg}polyline")]
    assert lines == ["#222222", "#d62728", "#1f5fd6"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["b6-loop"], "'b6-loop' is not known; name one of a5-loop, from-nothing, kidnapped, open-square"),
        (["a5-loop", "--accept"], "--world and --accept need a gateway that robots report to: add --gateway"),
        (
            ["a5-loop", "--reporter", "parking"],
            "--reporter is the robot whose observations are accepted: add",
        ),
    ],
)
def test_what_cannot_be_driven_is_refused_by_name(root, words, said):
    words = ["experiment", *words, "--site", str(root / "resources" / "sample_site")]
    done = CliRunner().invoke(command_line(words), words)
    assert done.exit_code == 1
    assert said in str(done.exception)
