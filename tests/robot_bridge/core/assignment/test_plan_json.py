"""Plans come back from their file as they were, and files that are none say what is wrong."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

from robot_bridge.core.assignment.job import StraightTravel
from robot_bridge.core.assignment.plan import ConePlan, LeftOut, plan_from_json, plan_to_json
from robot_bridge.core.assignment.solver import PREVIEW, Objective, assign
from robot_bridge.core.errors import PlanFileError
from tests.robot_bridge.core.assignment.jobs import scattered


@pytest.fixture(scope="module")
def plan() -> ConePlan:
    job = scattered(5, robots=2)
    made = assign(job, StraightTravel(job), Objective(method=PREVIEW))
    first = made.robots[0]
    with_history = replace(first, done=first.stops[:1], robot=replace(first.robot, range_m=812.5))
    left_out = (LeftOut(replace(job.targets[0], id="ä-9"), "fell over"),)
    return replace(made, robots=(with_history, *made.robots[1:]), left_out=left_out, crs="EPSG:32633")


def test_a_plan_comes_back_as_it_was(plan: ConePlan) -> None:
    again = plan_from_json(plan_to_json(plan))
    assert again == plan
    assert again.robots[1].robot.range_m == math.inf


def test_what_the_document_says_is_what_is_documented(plan: ConePlan) -> None:
    document = json.loads(plan_to_json(plan))
    assert (document["format"], document["version"]) == ("fleet-supervisor-assignment", 1)
    stop = document["robots"][0]["trips"][0]["stops"][0]
    assert list(stop) == [
        "kind", "id", "x", "y", "theta", "metres", "arrival_s", "begin_s", "end_s",
        "loaded", "unloaded", "aboard", "collected", "path",
    ]  # fmt: skip


def put(at: list, value: object):
    def change(document: dict) -> None:
        inner = document
        for key in at[:-1]:
            inner = inner[key]
        inner[at[-1]] = value

    return change


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (put(["format"], "x"), "no plan"),
        (put(["version"], 2), "version 2"),
        (put(["robots"], {}), "robots is no list"),
        (put(["robots", 0, "robot", "speed"], "fast"), r"robots\[0\].robot.speed is 'fast'"),
        (put(["robots", 0, "robot", "capacity"], True), r"robots\[0\].robot.capacity is True"),
        (put(["robots", 0, "colour"], 1), "'colour' is not known"),
        (put(["targets", 1], None), r"targets\[1\] is no object"),
        (put(["robots", 0, "trips", 0, "stops", 0, "path", 0], [1]), r"path\[0\] is no point"),
        (lambda document: document.pop("stores"), "'stores' is missing"),
    ],
)
def test_what_is_wrong_with_a_file_is_named(plan: ConePlan, change, told: str) -> None:
    document = json.loads(plan_to_json(plan))
    change(document)
    with pytest.raises(PlanFileError, match=told):
        plan_from_json(json.dumps(document))


def test_what_is_no_json_is_told() -> None:
    with pytest.raises(PlanFileError, match="no JSON"):
        plan_from_json("{")


def test_numbers_are_finite(plan: ConePlan) -> None:
    with pytest.raises(PlanFileError, match="out of range"):
        plan_from_json(plan_to_json(plan).replace('"theta":0.0', '"theta":1e999', 1))


def test_numbers_and_depths_beyond_all_bounds_are_refused(plan):
    with pytest.raises(PlanFileError, match="more than 40 digits"):
        plan_from_json(plan_to_json(plan).replace('"theta":0.0', '"theta":1' + 400 * "0", 1))
    with pytest.raises(PlanFileError, match="no JSON document"):
        plan_from_json(100_000 * "[")
