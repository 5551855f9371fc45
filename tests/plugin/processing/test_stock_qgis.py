"""What a stock QGIS does without the packages of ``pip``, and what it says of those that it would need.

All in one ``qgis_process`` that has no display and sees nothing of this environment.
"""

from __future__ import annotations

import base64
import json
import re

import numpy as np
import pyogrio.raw
import pytest
import shapely
from fleet_supervisor.robot_bridge.core.assignment.plan import check_plan, plan_from_json
from fleet_supervisor.robot_bridge.core.robotmap.binary import decode_text, encode
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text
from fleet_supervisor.robot_bridge.core.sites.site import read_site
from websockets.sync.client import connect

from tests.plugin.processing.conftest import Finished
from tests.support.patience import START
from tests.support.processes import Processes

UTM = "EPSG:32633"
SURFACES = {
    (640440.5, 5193488.5): "asphalt",
    (640486.5, 5193524.5): "slippery",
    (640440.5, 5193581.5): "parking pavement",
    (640520.5, 5193581.0): None,
}
"""What lies at places of the sample site."""


MAP = """\
%crs EPSG:32633
%origin 640420,5193480
%rotation 0
border;
0;60;
60;0;
#
obstacle;
7;1;2;house,A1;src=houses:4;
#
10;10;
30;10;
12.5;1;;
#
30;10;
30;30;
8;0;;
#
"""


def write_points(file, layer, places, **columns):
    """Write a GeoPackage of points in UTM 33 N."""
    pyogrio.raw.write(
        file, shapely.to_wkb([shapely.Point(place) for place in places]),
        [np.array(values) for values in columns.values()], list(columns),
        geometry_type="Point", crs=UTM, driver="GPKG", layer=layer,
    )  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with what goes in: cones, robots, a store, drives, placed cones, a map and a binary one."""
    made = tmp_path_factory.mktemp("stock")
    rows = [(640432 + 5 * k, 5193486.2) for k in range(6)]
    write_points(made / "cones.gpkg", "cones", rows, id=[f"c{k}" for k in range(6)])
    write_points(made / "robots.gpkg", "robots", [(640430, 5193486), (640432, 5193488)], id=["r1", "r2"])
    write_points(made / "places.gpkg", "places", list(SURFACES), number=[0, 1, 2, 3])
    write_points(made / "stores.gpkg", "stores", [(640431, 5193487)], id=["shed"])
    times = np.datetime64("2026-09-21T14:13:20", "ms") + np.arange(11) * np.timedelta64(1000, "ms")
    drive = [(640440.0 + k, 5193488.0) for k in range(11)]
    write_points(made / "drive.gpkg", "positions", drive, robot=["r1"] * 11, time=times, v=[1.0] * 11)
    x, y = np.array([640460.0, 640465.0]), np.array([5193488.0, 5193488.0])
    texts = {"cone": ["c1", "c2"], "robot": ["r1", "r1"], "layout": ["slalom", "slalom"]}
    northing = y + np.array([0.05, 0.5])
    places = {"planned_easting": x, "planned_northing": y, "easting": x, "northing": northing}
    write_points(made / "placed.gpkg", "placed", list(zip(x, northing, strict=True)), **places, **texts)
    (made / "given.map").write_text(MAP)
    (made / "binary.map").write_bytes(encode(MAP))
    return made


def runs(root, data, folder) -> dict[str, list[str]]:
    """Return the words of each run, by a name."""
    site, project = root / "resources" / "sample_site", "--PROJECT_PATH="
    roads = f"ROADS={site / 'site.gpkg'}|layername=road_centrelines"
    sample = f"{project}{site / 'sample_site.qgz'}"
    campus = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    layers = [f"OBSTACLES={campus}|layername={name}" for name in ("buildings", "walls", "furniture")]
    window = ["run", "fleet:exportrobotmap", "--", *layers, "CENTER=48,48", "WIDTH=104", "HEIGHT=104"]
    places = ["START=640430,5193530 [EPSG:32633]", "GOAL=640600,5193570 [EPSG:32633]"]
    inputs = [f"{name.upper()}={folder / name}.gpkg" for name in ("cones", "robots", "stores")]
    lines, given = [f"ROUTE={folder}/r.gpkg", f"PATH={folder}/p.gpkg"], f"MAP={folder / 'given.map'}"
    surfaces = f"{site / 'site.gpkg'}|layername=road_surfaces"
    formats = [f"FORMATS={name}" for name in ("occupancy", "geojson", "geopackage", "svg", "png")]
    plan = [f"TARGETS={folder}/t.gpkg", f"PATHS={folder}/w.gpkg", f"PLAN={folder}/plan.json", "CAPACITY=4"]
    photo = f"BACKGROUND={site / 'orthophoto.tif'}"
    shaped = ["CHAIN=true", "PLANE_LOW=0.3", "PLANE_HIGH=1", "HEIGHT_STEP=0.5"]
    return {
        "shaped": [*window, *shaped, f"OUTPUT={folder}/shaped.txt"],
        "dissolved": [*window, "DISSOLVE=true", f"OUTPUT={folder}/dissolved.txt"],
        "compact": [*window, "FORMAT=compact", f"OUTPUT={folder}/compact.rmap"],
        "binary": [*window, "FORMAT=binary", f"OUTPUT={folder}/binary.rmap"],
        "load binary": ["run", "fleet:loadrobotmap", "--", f"MAP={folder / 'binary.map'}",
                        f"SEGMENTS={folder}/s_of_binary.gpkg"],
        "load": ["run", "fleet:loadrobotmap", "--", given, f"SEGMENTS={folder}/s.gpkg"],
        "check": ["run", "fleet:checkrobotmap", "--", given, f"FINDINGS={folder}/f.gpkg"],
        "navigation": ["run", "fleet:exportnavigationmap", "--", given, "RESOLUTION=0.1", *formats,
                       f"OUTPUT={folder}/nav"],
        "surfaces": ["run", "fleet:buildroadsurfaces", "--", roads, f"SURFACES={folder}/made.gpkg"],
        "surface": ["run", "fleet:surfaceatpoint", "--", f"POINTS={folder / 'places.gpkg'}",
                    f"SURFACES={surfaces}", f"OUTPUT={folder}/told.gpkg"],
        "route": ["run", "fleet:route", "--", roads, *places, *lines],
        "roads": ["run", "fleet:exportroadnetwork", "--", roads, "FORMATS=nav2", "FORMATS=lif",
                  "FORMATS=lanelet2", "ORIGIN=640420,5193480", "NAME=site", f"OUTPUT={folder}/roads"],
        "assign": ["run", "fleet:assigncones", "--", *inputs, roads, *plan],
        "trajectories": ["run", "fleet:trajectories", "--", f"INPUT={folder / 'drive.gpkg'}",
                         f"OUTPUT={folder}/lines.gpkg"],
        "report": ["run", "fleet:asplacedreport", "--", f"INPUT={folder / 'placed.gpkg'}", photo,
                   f"OUTPUT={folder}/report.pdf"],
        "degrees": ["run", "native:reprojectlayer", "--", f"INPUT={folder / 'places.gpkg'}",
                    "TARGET_CRS=EPSG:4326", f"OUTPUT={folder}/degrees.gpkg"],
        "publish": ["run", "fleet:publishsite", sample, "--", "BOUNDS=640420,640620,5193480,5193640",
                    f"FOLDER={folder}/site"],
        "expression": ["run", "native:fieldcalculator", sample, "--", f"INPUT={folder}/degrees.gpkg",
                       "FIELD_NAME=ground", "FIELD_TYPE=2", "FORMULA=road_surface($x, $y)",
                       f"OUTPUT={folder}/ground.gpkg"],
    }  # fmt: skip


@pytest.fixture(scope="module")
def ended(qgis_process, root, data, folder) -> dict[str, Finished]:
    """What became of each run."""
    given = runs(root, data, folder)
    (folder / "runs.json").write_text(json.dumps(list(given.values())))
    words = (f"RUNS={folder / 'runs.json'}", f"ENDED={folder / 'ended.json'}")
    done = qgis_process("run", "script:severalruns", "--", *words, packages=False)
    assert done.status == 0, done.said
    became = json.loads((folder / "ended.json").read_text())
    return {
        name: Finished(one["status"], one["results"], one["said"])
        for name, one in zip(given, became, strict=True)
    }


@pytest.fixture
def fine(ended):
    """Return a run that has to have gone well."""

    def of(name) -> Finished:
        assert ended[name].status == 0, ended[name].said
        return ended[name]

    return of


@pytest.mark.parametrize(
    ("name", "words", "written"),
    [
        ("dissolved", "need the Python package shapely 2", "dissolved.txt"),
        ("compact", "needs the Python", "compact.rmap"),
        ("binary", "needs the Python package zstandard", "binary.rmap"),
        ("load binary", "needs the Python package zstandard", "s_of_binary.gpkg"),
    ],
)
def test_a_missing_package_is_named_before_the_run_and_nothing_is_written(
    ended, folder, name, words, written
):
    done = ended[name]
    assert done.status != 0
    assert words in done.said and "Traceback" not in done.said
    assert "10..." not in done.said, "a layer was read before"
    assert not (folder / written).exists()


def test_surfaces_of_centrelines_need_a_package(ended, folder):
    done = ended["surfaces"]
    assert done.status != 0
    assert "The Python package shapely 2 is missing" in done.said and "Traceback" not in done.said
    assert not (folder / "made.gpkg").exists()


def test_reduction_that_needs_no_package_is_done(fine):
    told = re.search(r"obstacles, (\d+) segments became \d+ obstacles, (\d+) segments", fine("shaped").said)
    assert int(told[1]) > int(told[2]) == fine("shaped").result("SEGMENT_COUNT")


def test_a_map_as_text_is_loaded_and_checked(fine):
    assert fine("load").result("SEGMENT_COUNT") == read_text(MAP).segment_count
    assert fine("check").result("FINDING_COUNT") >= 0


def test_navigation_maps_are_written(fine):
    assert fine("navigation").result("FILE_COUNT") == 7


def column(file, name):
    meta, _, _, columns = pyogrio.raw.read(file)
    return dict(zip(meta["fields"], columns, strict=True))[name].tolist()


def test_surfaces_are_told_at_places(fine, folder):
    assert (fine("surface").result("ON_COUNT"), fine("surface").result("OFF_COUNT")) == (3, 1)
    assert column(folder / "told.gpkg", "surface") == list(SURFACES.values())


def test_the_expression_function_is_there_with_no_display(fine, folder):
    fine("degrees"), fine("expression")
    assert column(folder / "ground.gpkg", "ground") == list(SURFACES.values())


def test_ways_are_found_and_roads_exported(fine, folder):
    assert fine("route").result("METRES") == pytest.approx(199.751, abs=0.001)
    fine("roads")
    assert (folder / "roads" / "site.osm").read_text().count('v="lanelet"') > 50


def test_cones_are_assigned_by_the_preview(fine, folder):
    fine("assign")
    plan = plan_from_json((folder / "plan.json").read_text("utf-8"))
    assert check_plan(plan) == []
    assert plan.method.startswith("preview") and len(plan.targets) == 6


def test_drives_become_lines(fine):
    assert (fine("trajectories").result("LINE_COUNT"), fine("trajectories").result("POSITION_COUNT")) == (
        1,
        11,
    )


def test_placed_cones_become_a_report(fine, folder):
    done = fine("report")
    assert (done.result("CONE_COUNT"), done.result("WITHIN_COUNT")) == (2, 1)
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF-")


def shapes(robot_map):
    """Return what a map says, whatever its obstacles are numbered."""
    return sorted(
        (
            o.semantics,
            sorted(o.ext.items()),
            int(o.shape_type),
            o.height.tolist(),
            o.a.tolist(),
            o.b.tolist(),
        )
        for o in robot_map.obstacles
    )


def test_a_published_site_is_what_a_gateway_serves(fine, folder, tmp_path):
    fine("publish")
    words = [
        "serve",
        "--site",
        folder / "site",
        "--port",
        "0",
        "--database",
        f"sqlite:///{tmp_path / 'fleet.db'}",
    ]
    with Processes(tmp_path / "logs") as processes:
        processes.start_bridge("gateway", words)
        address = processes.wait_for_line("gateway", r"listening on (ws://\S+:\d+)", START).group(1)
        with connect(f"{address}/robot", max_size=None) as robot:
            robot.send(json.dumps({"jsonrpc": "2.0", "id": 1, "method": "Ready", "params": {"magic": 7}}))
            calls = (json.loads(robot.recv(10)) for _ in range(5))
            call = next(frame for frame in calls if frame.get("method") == "SetMap")
    served = read_text(decode_text(base64.b64decode(call["params"]["map"])))
    assert served.meta["id"] == "sample" and served.meta["version"] == "1"
    assert shapes(served) == shapes(read_site(folder / "site").whole_map())


def test_the_map_of_a_publication_is_the_map_exported_from_the_layers(fine, folder, by_words, root, tmp_path):
    fine("publish")
    project = root / "resources" / "sample_site" / "sample_site.qgz"
    layers = ("Buildings", "Walls", "Columns", "Litter bins", "Benches", "Stairs", "Ramp")
    words = [f"OBSTACLES={name}" for name in layers]
    words += ["EXTENT=640420,640620,5193480,5193640", f"OUTPUT={tmp_path / 'map.txt'}"]
    done = by_words("run", "fleet:exportrobotmap", f"--PROJECT_PATH={project}", "--", *words)
    assert done.status == 0, done.said
    exported = read_text((tmp_path / "map.txt").read_text())
    published = read_site(folder / "site").whole_map()
    assert len(shapes(published)) > 40
    (ramp,) = [o for o in published.obstacles if o.shape_type == ShapeType.RAMP]
    assert ramp.ext["n"] == "0.083,0,0.9965"
    assert shapes(exported) == shapes(published)
    assert exported.border == published.border
