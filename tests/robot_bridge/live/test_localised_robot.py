"""A real robot that knows its place only by its filter, at a real gateway."""

from __future__ import annotations

import math

import typer
from click.testing import Result
from typer.testing import CliRunner

from robot_bridge.cli.robot import robot

SETTINGS = """
[laser]
beams = 60
[filter]
least = 200
most = 2000
"""
GOAL = 111.4, 66.0


def test_it_goes_where_it_is_sent_by_what_it_believes_and_says_how_sure_it_is(
    start_bridge, sample_site, tmp_path
):
    settings = tmp_path / "robot.toml"
    settings.write_text(SETTINGS, encoding="utf-8")
    bridge = start_bridge(sample_site)
    options = [
        "--localisation",
        "filter",
        "--world",
        sample_site,
        "--robot-settings",
        settings,
        "--speed",
        "2",
    ]
    # Six metres along a road on which nothing stands: before a bench it would wait.
    bridge.start_robot("sure", (110.0, 60.0, 1.2), options=options)
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 20})
    desk.wait_for_robots("sure")
    # At first it says that it has no map.
    desk.until(lambda: desk.robots["sure"].get("accuracy") and not desk.robots["sure"].get("status"), 30)
    desk.send("go-there", "sure", "SetPosEnd", x=GOAL[0], y=GOAL[1])
    assert desk.wait_for_step("go-there", "reached")["deviation"] <= 0.2
    report = desk.robots["sure"]
    assert math.dist((report["x"], report["y"]), GOAL) < 0.2
    assert 0.0 < report["accuracy"] < 0.5


def refused(*words: str) -> Result:
    app = typer.Typer()
    app.command()(robot)
    return CliRunner().invoke(app, ["--name", "r1", "--url", "ws://127.0.0.1:1/robot", *words])


def test_a_filter_without_a_world_is_refused_and_a_place_in_a_house(sample_site):
    done = refused("--localisation", "filter")
    assert "give both" in str(done.exception)
    done = refused("--localisation", "filter", "--world", str(sample_site), "--pose", "900,0,0")
    assert "pose (900.0, 0.0) is not on the map of world sample" in str(done.exception)
