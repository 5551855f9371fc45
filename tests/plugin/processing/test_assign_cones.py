"""``fleet:assigncones``: cones of a layer shared out among robots, in QGIS and by a script's words."""

from __future__ import annotations

import json
import re
import shlex
import shutil

import numpy as np
import pyogrio
import pytest
import shapely
from fleet_supervisor.plugin.processing.algorithms import assign_cones
from fleet_supervisor.plugin.processing.common import road_sources
from fleet_supervisor.robot_bridge.core.assignment import job, pyvrp_search, schedules, solver
from fleet_supervisor.robot_bridge.core.assignment.plan import ConePlan, check_plan, plan_from_json
from qgis.core import QgsProcessingContext, QgsProcessingException, QgsProject

UTM = "EPSG:32633"
X, Y = 640500.0, 5193500.0
BLOCK = ("0 0, 100 0", "100 0, 100 40", "100 40, 0 40", "0 40, 0 0")


@pytest.fixture
def layers(make_layer):
    """Cones on two sides of a block of one-way roads, two robots, a store."""
    cones = [(f"POINT({X + x} {Y + y})", f"c{k}", stage) for k, (x, y, stage) in enumerate(
        [(20, 1, 0), (40, 1, 0), (60, 1, 0), (20, 39, 1), (40, 39, 1), (60, 39, 1)], 1)]  # fmt: skip
    robots = [(f"POINT({X} {Y + 5})", "R1", 2, None), (f"POINT({X} {Y + 10})", "R2", 3, 2.0)]

    def moved(line):
        points = [point.split() for point in line.split(", ")]
        return "LINESTRING(" + ", ".join(f"{X + float(x)} {Y + float(y)}" for x, y in points) + ")"

    return {
        "CONES": make_layer("cones", "Point", "&field=id:string&field=stage:integer", cones, UTM),
        "ROBOTS": make_layer(
            "robots", "Point", "&field=id:string&field=capacity:integer&field=speed:double", robots, UTM
        ),
        "STORES": make_layer("stores", "Point", "&field=id:string", [(f"POINT({X} {Y + 20})", "shed")], UTM),
        "ROADS": make_layer(
            "roads", "LineString", "&field=oneway:string&field=width_m:double",
            [(moved(line), "yes", 6.0) for line in BLOCK], UTM,
        ),
    }  # fmt: skip


@pytest.fixture
def run(provider, listener, tmp_path):
    """Run the algorithm and return its outputs and the plan."""
    import processing

    project = QgsProject()

    def do(feedback=None, **parameters) -> tuple[dict, ConePlan | None]:
        context = QgsProcessingContext()
        context.setProject(project)
        file = tmp_path / "plan.json"
        everything = {
            "TARGETS": "memory:", "PATHS": "memory:", "PLAN": str(file), "METHOD": "preview", **parameters,
        }  # fmt: skip
        results = processing.run(
            "fleet:assigncones", everything, context=context, feedback=feedback or listener
        )
        return results, plan_from_json(file.read_text("utf-8")) if file.exists() else None

    return do


def test_layers_become_a_plan_that_can_be_driven(run, layers, listener):
    results, plan = run(**layers, CAPACITY=8, SERVICE_TIME=7, STORE_TIME=11)
    assert check_plan(plan) == []
    assert [(one.robot.id, one.robot.capacity, one.robot.speed) for one in plan.robots] == [
        ("R1", 2, 1.0),
        ("R2", 3, 2.0),
    ]
    assert (plan.crs, plan.travel) == (UTM, results["TRAVEL_USED"])
    assert plan.travel.startswith("roads")
    assert {target.service_s for target in plan.targets} == {7.0}
    assert {store.service_s for store in plan.stores} == {11.0}
    assert results["END_S"] == plan.end_s
    assert results["METRES"] == pytest.approx(plan.metres)
    assert results["ROBOT_COUNT"] == sum(bool(one.stops) for one in plan.robots)
    assert any("Robot R2: " in info for info in listener.infos)


def test_targets_and_paths_say_what_the_plan_says(run, layers):
    results, plan = run(**layers)
    stops = {(one.robot.id, stop.kind, stop.id, round(stop.arrival_s, 2)) for one, stop in plan.all_stops()}
    targets = list(results["TARGETS"].getFeatures())
    assert {(f["robot"], f["kind"], f["id"], f["eta_s"]) for f in targets} == stops
    for robot in ("R1", "R2"):
        mine = sorted((f["sequence"], f["eta_s"], f["trip"]) for f in targets if f["robot"] == robot)
        assert [row[0] for row in mine] == list(range(1, len(mine) + 1))
        assert [row[1] for row in mine] == sorted(row[1] for row in mine)
        assert [row[2] for row in mine] == sorted(row[2] for row in mine)
    by_key = {(f["robot"], f["sequence"]): f for f in targets}
    for path in results["PATHS"].getFeatures():
        target = by_key[path["robot"], path["sequence"]]
        end = path.geometry().asPolyline()[-1]
        assert end.distance(target.geometry().asPoint()) < 0.01
        assert path["eta_s"] == target["eta_s"]
    assert results["TARGETS"].crs().authid() == UTM


def test_stages_and_one_way_roads_count(run, layers):
    _, plan = run(**layers, OBJECTIVE="distance")
    first = max(stop.end_s for _, stop in plan.all_stops() if stop.id in ("c1", "c2", "c3"))
    assert all(stop.begin_s >= first for _, stop in plan.all_stops() if stop.id in ("c4", "c5", "c6"))
    for one in plan.robots:
        for stop in one.stops:
            south = [point for point in stop.path if abs(point[1] - Y) < 0.01 and X < point[0] < X + 100]
            assert [point[0] for point in south] == sorted(point[0] for point in south)


def test_without_roads_it_says_that_lines_are_straight(run, layers, listener):
    layers.pop("ROADS")
    _, plan = run(**layers, TASK="collect", STAGE_FIELD="")
    assert check_plan(plan) == []
    assert plan.travel == "straight lines"
    assert any("No roads are given" in warning for warning in listener.warnings)
    assert {target.kind for target in plan.targets} == {"collect"}
    assert {target.stage for target in plan.targets} == {0}


def test_keepouts_close_roads(run, layers, make_layer):
    ring = f"{X + 80} {Y - 5}, {X + 90} {Y - 5}, {X + 90} {Y + 5}, {X + 80} {Y + 5}, {X + 80} {Y - 5}"
    keepout = make_layer("wet", "Polygon", "&field=name:string", [(f"POLYGON(({ring}))", "wet")], UTM)
    with pytest.raises(QgsProcessingException, match=r"More than 3 m from every road .*cone c1"):
        run(**layers, KEEPOUTS=[keepout], DISTANCE=3.0)


def test_pyvrp_is_used_where_it_is(run, layers):
    pytest.importorskip("pyvrp")
    results, plan = run(**layers, METHOD="automatic", TIME_LIMIT=1)
    assert results["METHOD_USED"].startswith("pyvrp")
    assert check_plan(plan) == []


PHASES = {
    "network": (road_sources, "network_of_roads"),
    "distances": (job, "road_matrix"),
    "savings": (solver, "trips_by_savings"),
    "improving": (solver, "improved"),
    "pyvrp": (pyvrp_search, "trips_by_pyvrp"),
    "paths": (schedules, "plan_of"),
    "writing": (assign_cones, "write_whole"),
}
"""What comes one after the other, and who does it."""


@pytest.mark.parametrize("phase", [name for name in PHASES if name != "writing"])
def test_a_cancel_in_one_phase_lets_none_come_after_it(run, layers, listener, monkeypatch, phase):
    pytest.importorskip("pyvrp")
    entered = []

    def noted(name, work):
        def do(*given, **named):
            entered.append(name)
            if name == phase:
                listener.cancel()
            return work(*given, **named)

        return do

    for name, (module, function) in PHASES.items():
        monkeypatch.setattr(module, function, noted(name, getattr(module, function)))
    results, plan = run(**layers, STAGE_FIELD="", METHOD="pyvrp", TIME_LIMIT=600)
    names = list(PHASES)
    assert set(entered) == set(names[: names.index(phase) + 1])
    assert plan is None
    assert "METRES" not in results


def test_a_cancel_leaves_nothing(run, layers, cancels_at):
    results, plan = run(cancels_at(41), **layers, METHOD="pyvrp", TIME_LIMIT=60)
    assert plan is None
    assert "METRES" not in results


@pytest.mark.parametrize(
    ("layer", "fields", "features", "told"),
    [
        ("CONES", "&field=demand:string", [("POINT(0 0)", "two")], "cones, feature 1: demand is 'two'"),
        ("CONES", "&field=demand:double", [("POINT(0 0)", 1.5)], "demand is 1.5; give a whole number"),
        ("CONES", "&field=task:string", [("POINT(0 0)", "eat")], "Cone 1 is to be 'eat'"),
        ("ROBOTS", "&field=capacity:integer", [("POINT(0 0)", 0)], "capacity of robot 1 is 0"),
        ("ROBOTS", "&field=range_m:double", [("POINT(0 0)", 5.0)], "no robot has the battery for"),
    ],
)
def test_what_is_wrong_is_named(run, layers, make_layer, layer, fields, features, told):
    layers.pop("ROADS")
    moved = [(f"POINT({X} {Y})", *values) for _, *values in features]
    layers[layer] = make_layer(layer.lower(), "Point", fields, moved, UTM)
    with pytest.raises(QgsProcessingException, match=told):
        run(**layers)


def test_a_plan_that_cannot_be_written_is_refused_before_anything_is_planned(run, layers, monkeypatch):
    monkeypatch.setattr(assign_cones, "assign", lambda *_: pytest.fail("it was planned"))
    with pytest.raises(QgsProcessingException, match=r"The plan cannot be written to /nowhere/plan\.json"):
        run(**layers, PLAN="/nowhere/plan.json")


def test_a_layer_without_cones_is_warned_of(run, layers, make_layer, listener):
    none = make_layer("cones", "Point", "&field=id:string", [])
    assert run(**{**layers, "CONES": none})[0]["TRIP_COUNT"] == 0
    assert "CONES holds no cone: there is nothing to plan." in listener.warnings


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Files of robots and a store on the straight of the sample site."""
    folder = tmp_path_factory.mktemp("assign")

    def write(name, places, **columns):
        points = shapely.to_wkb([shapely.Point(place) for place in places])
        pyogrio.raw.write(
            folder / f"{name}.gpkg", points, [np.array(values) for values in columns.values()],
            list(columns), geometry_type="Point", crs=UTM, driver="GPKG", layer=name,
        )  # fmt: skip
        return folder / f"{name}.gpkg"

    write("robots", [(640430, 5193486), (640432, 5193488), (640434, 5193486)], id=["r1", "r2", "r3"])
    write("stores", [(640431, 5193487)], id=["shed"])
    return folder


@pytest.fixture(scope="module")
def placed(by_words, files):
    """The cones of a layout, in a file beside the robots."""
    done = by_words(
        "run", "fleet:conelayout", "--", "LAYOUT=iso3888_1", f"POINT=640432,5193486.2 [{UTM}]", "HEADING=90",
        "DIMENSIONS=vehicle_width=1.7; exit_length=15", f"SITE_CRS={UTM}",
        f"CONES={files / 'cones.gpkg'}", f"FINDINGS={files / 'findings.gpkg'}",
    )  # fmt: skip
    assert done.status == 0, done.said
    return files / "cones.gpkg"


def test_a_layout_is_assigned_by_a_script(by_words, root, files, placed):
    site = root / "resources" / "sample_site" / "sample_site.gpkg"
    done = by_words(
        "run", "fleet:assigncones", "--",
        *(f"{name.upper()}={files / name}.gpkg" for name in ("cones", "robots", "stores")),
        f"ROADS={site}|layername=road_centrelines", "CAPACITY=4", "TIME_LIMIT=1",
        *(f"{name.upper()}={files / name}.gpkg" for name in ("targets", "paths")),
        f"PLAN={files / 'plan.json'}",
    )  # fmt: skip
    assert done.status == 0, done.said
    plan = plan_from_json((files / "plan.json").read_text("utf-8"))
    assert check_plan(plan) == []
    assert plan.method.startswith("pyvrp")
    cones = pyogrio.read_info(placed)["features"]
    assert len(plan.targets) == cones > 10
    stops = pyogrio.read_info(files / "targets.gpkg")["features"]
    assert stops == sum(len(one.stops) for one in plan.robots)
    assert done.result("END_S") == pytest.approx(plan.end_s, rel=1e-6)
    assert json.loads((files / "plan.json").read_text("utf-8"))["crs"] == UTM


def test_it_runs_as_the_guide_says(by_words, placed, root, tmp_path):
    guide = (root / "docs" / "assignment.md").read_text(encoding="utf-8")
    for name, block in re.findall(r"^`build/(\w+\.geojson)`:\n\n((?:    .*\n)+)", guide, re.MULTILINE):
        (tmp_path / name).write_text(block, encoding="utf-8")
    shutil.copy(placed, tmp_path)
    command = re.search(r"^    qgis_process\.bin (run fleet:assigncones (?:.*\\\n)*.*)$", guide, re.MULTILINE)
    # What it finds in a second is a plan as well.
    words = [
        word.replace("=build/", f"={tmp_path}/").replace("=resources/", f"={root}/resources/")
        for word in shlex.split(command[1].replace("\\\n", " ").replace("TIME_LIMIT=5", "TIME_LIMIT=1"))
    ]
    done = by_words(*words)
    assert done.status == 0, done.said
    plan = plan_from_json((tmp_path / "plan.json").read_text("utf-8"))
    assert check_plan(plan) == []
    assert [(one.robot.id, one.robot.capacity, one.robot.speed) for one in plan.robots] == [
        ("r1", 4, 1.0),
        ("r2", 4, 1.5),
    ]


def test_the_document_has_what_the_guide_shows(root):
    guide = (root / "docs" / "assignment.md").read_text(encoding="utf-8")
    shown = re.search(r"^    \{\"format\"(?:.*\n)+?\n", guide, re.MULTILINE)[0]
    assert plan_from_json(shown).robots[0].trips[0].stops[0].id == "shed"
