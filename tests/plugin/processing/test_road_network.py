"""``fleet:buildroadnetwork``, ``fleet:checkroadnetwork`` and ``fleet:route`` on layers of all kinds."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup
from fleet_supervisor.plugin.processing.algorithms.road_network import FindRoute
from fleet_supervisor.plugin.processing.common.road_sources import GraphEngine
from fleet_supervisor.robot_bridge.core.errors import NoRouteError
from fleet_supervisor.robot_bridge.core.roads import network as noding
from fleet_supervisor.robot_bridge.core.roads.network import build_network, centrelines
from fleet_supervisor.robot_bridge.core.roads.routes import Router
from qgis.core import (
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProject,
    QgsVectorLayer,
)

ALL = (
    "&field=width_m:double&field=surface:string&field=oneway:string&field=maxspeed:string&field=closed:string"
)
SQUARE = [
    ("LINESTRING(0 0, 10 0)", 4.0, "asphalt", "no", "36", "no"),
    ("LINESTRING(10 0, 10 10)", 4.0, "asphalt", "no", "36", "no"),
    ("LINESTRING(10 10, 0 10)", 4.0, "slippery", "no", "36", "no"),
    ("LINESTRING(0 10, 0 0)", 4.0, "asphalt", "no", "36", "no"),
]
PLACES = {"START": "0,0", "GOAL": "10,9"}


def square(make_layer, **changes):
    """Return the square; ``changes`` are values of its second road, by field."""
    names = ("width_m", "surface", "oneway", "maxspeed", "closed")
    second = [SQUARE[1][0], *(changes.get(n, v) for n, v in zip(names, SQUARE[1][1:], strict=True))]
    return make_layer("roads", fields=ALL, features=[SQUARE[0], second, *SQUARE[2:]])


@pytest.fixture
def run(provider, listener):
    """Run one of the algorithms and return its outputs."""
    import processing

    without_layers = QgsProject()

    def do(name, layer, feedback=None, project=without_layers, **parameters):
        outputs = {
            "buildroadnetwork": ("EDGES", "NODES"),
            "checkroadnetwork": ("FINDINGS",),
            "route": ("ROUTE", "PATH"),
        }
        context = QgsProcessingContext()
        context.setProject(project)
        everything = {"ROADS": layer, **dict.fromkeys(outputs[name], "memory:"), **parameters}
        return processing.run(f"fleet:{name}", everything, context=context, feedback=feedback or listener)

    return do


def values(layer, *names):
    return [tuple(feature[name] for name in names) for feature in layer.getFeatures()]


def test_edges_carry_what_is_known_of_their_roads(run, make_layer):
    changes = {"width_m": 2.5, "surface": "slippery", "oneway": "-1", "maxspeed": "20 mph", "closed": "yes"}
    made = run("buildroadnetwork", square(make_layer, **changes))
    assert (made["EDGE_COUNT"], made["NODE_COUNT"], made["PART_COUNT"]) == (4, 4, 1)
    known = values(made["EDGES"], "feature", "length_m", "width_m", "surface", "direction", "closed", "level")
    assert known[:2] == [(1, 10.0, 4.0, "asphalt", 0, 0, 0), (2, 10.0, 2.5, "slippery", -1, 1, 0)]
    assert [speed for (speed,) in values(made["EDGES"], "speed_ms")][:2] == pytest.approx([10.0, 8.9408])
    assert {ends for (ends,) in values(made["NODES"], "ends")} == {2}
    assert made["EDGES"].crs().authid() == "EPSG:32633"


def test_the_edges_are_roads_again(run, make_layer):
    made = run("buildroadnetwork", square(make_layer, oneway="-1", closed="yes"))
    again = run("buildroadnetwork", made["EDGES"])
    names = ("length_m", "width_m", "surface", "direction", "speed_ms", "closed", "level")
    assert values(again["EDGES"], *names) == values(made["EDGES"], *names)


@pytest.mark.parametrize(
    ("fields", "row", "edges"),
    [
        ("&field=bridge:string", ("yes",), 2),
        ("&field=bridge:string", ("no",), 4),
        ("&field=tunnel:string", ("building_passage",), 2),
        ("&field=layer:string", ("1",), 2),
        ("&field=layer:string&field=bridge:string", ("0", "yes"), 4),
        ("&field=level:integer", (-1,), 2),
    ],
)
def test_roads_pass_at_bridges_and_tunnels(run, make_layer, fields, row, edges):
    roads = [("LINESTRING(0 0, 10 0)", *[None] * len(row)), ("LINESTRING(5 -5, 5 5)", *row)]
    made = run("buildroadnetwork", make_layer("roads", fields=fields, features=roads))
    assert made["EDGE_COUNT"] == edges


def test_expressions_and_the_role_of_the_layer_win_over_fields(run, make_layer):
    layer = square(make_layer)
    keep_setup(layer, LayerSetup("road_centreline", LayerExpressions(width="7", semantics="'gravel'")))
    assert values(run("buildroadnetwork", layer)["EDGES"], "width_m", "surface")[0] == (7.0, "gravel")
    given = run(
        "buildroadnetwork", layer, WIDTH="3", SPEED="2.5", DIRECTION="'yes'", CLOSED="true", LEVEL="2"
    )
    known = values(given["EDGES"], "width_m", "speed_ms", "direction", "closed", "level")
    assert known[0] == (3.0, 2.5, 1, 1, 2)


def test_the_filter_and_the_width_of_the_layers_role_hold_of_its_selected_roads_too(run, make_layer):
    layer = square(make_layer)
    expressions = LayerExpressions(width="7", filter="\"surface\" = 'asphalt'")
    keep_setup(layer, LayerSetup("road_centreline", expressions))
    assert run("buildroadnetwork", layer)["EDGE_COUNT"] == 3
    layer.selectByExpression("\"surface\" = 'slippery' or $id = 1")
    project = QgsProject()
    project.addMapLayer(layer)
    selected = QgsProcessingFeatureSourceDefinition(layer.id(), selectedFeaturesOnly=True)
    edges = run("buildroadnetwork", selected, project=project)["EDGES"]
    assert values(edges, "surface", "width_m") == [("asphalt", 7.0)]


def test_what_is_not_understood_is_named_and_has_a_default(run, make_layer, listener):
    made = run(
        "buildroadnetwork", square(make_layer, oneway="perhaps", maxspeed="walk", closed="maybe", width_m=-1)
    )
    assert values(made["EDGES"], "width_m", "direction", "speed_ms", "closed")[1] == (3.5, 0, 1.0, 1)
    said = "\n".join(listener.warnings)
    assert "feature 2: its direction 'perhaps'" in said
    assert "feature 2: its speed 'walk'" in said
    assert "feature 2: whether it is closed, 'maybe'" in said
    assert made["WARNING_COUNT"] == len(listener.warnings) == 5


def test_findings_are_points_and_repairs_make_them_go(run, make_layer, listener):
    layer = make_layer("roads", features=[("LINESTRING(0 0, 10 0)", 1), ("LINESTRING(5 0.25, 5 9)", 1)])
    found = run("checkroadnetwork", layer)
    assert (found["FINDING_COUNT"], found["GAP_COUNT"], found["DEAD_END_COUNT"]) == (5, 1, 3)
    (gap,) = (f for f in found["FINDINGS"].getFeatures() if f["kind"] == "gap")
    assert (gap["feature"], gap["repairable"]) == (2, 1)
    assert "0.250 m short of road 1" in gap["text"]
    assert (gap.geometry().asPoint().x(), gap.geometry().asPoint().y()) == (5.0, 0.25)
    made = run("buildroadnetwork", layer, REPAIR=True)
    assert (made["EDGE_COUNT"], made["PART_COUNT"], made["REPAIR_COUNT"]) == (3, 1, 1)
    assert any("Repaired: gap of feature 2" in info for info in listener.infos)
    assert run("checkroadnetwork", made["EDGES"])["GAP_COUNT"] == 0
    assert run("buildroadnetwork", layer, REPAIR=True, TOLERANCE=0.2)["REPAIR_COUNT"] == 0


def test_degrees_are_brought_into_metres(run, make_layer):
    layer = make_layer("roads", features=[("LINESTRING(16.84 46.89, 16.8413 46.89)", 1)], crs="EPSG:4326")
    made = run("buildroadnetwork", layer, SITE_CRS="EPSG:32633")
    ((metres,),) = values(made["EDGES"], "length_m")
    assert 98 < metres < 100
    with pytest.raises(QgsProcessingException, match="not metres on a plane"):
        run("buildroadnetwork", layer)


def test_the_shortest_way_has_its_stretches_and_a_path(run, make_layer):
    made = run("route", square(make_layer), TURNING_RADIUS=1.0, SPACING=0.5, **PLACES)
    assert made["METRES"] == pytest.approx(19.0)
    assert made["SECONDS"] == pytest.approx(1.9)
    stretches = values(made["ROUTE"], "order", "feature", "length_m", "surface")
    assert stretches == [(0, 1, 10.0, "asphalt"), (1, 2, 9.0, "asphalt")]
    (path,) = made["PATH"].getFeatures()
    assert (path["points"], path["tight"]) == (made["POINT_COUNT"], 0)
    assert 18.5 < path.geometry().length() < 19.0
    assert path["engine"] == made["ENGINE_USED"]


def test_closed_roads_directions_surfaces_and_widths_are_honoured(run, make_layer):
    assert run("route", square(make_layer, closed="yes"), START="0,0", GOAL="9,10")[
        "METRES"
    ] == pytest.approx(19)
    layer = square(make_layer, oneway="-1")
    assert run("route", layer, START="10,1", GOAL="10,9")["METRES"] == pytest.approx(32.0)
    with pytest.raises(QgsProcessingException, match="No way leads"):
        run("route", layer, START="10,1", GOAL="10,9", SURFACES="asphalt")
    with pytest.raises(QgsProcessingException, match="more than 20 m from every road"):
        run("route", layer, START="10,1", GOAL="10,9", LEAST_WIDTH=5)


def test_no_way_leads_where_the_robot_is_wider_than_the_road(run, make_layer):
    layer = square(make_layer, width_m=1.0)
    assert run("route", layer, **PLACES)["METRES"] == pytest.approx(19.0)
    assert run("route", layer, START="0,0", GOAL="9,10", ROBOT_WIDTH=1.2)["METRES"] == pytest.approx(19.0)
    with pytest.raises(QgsProcessingException, match=r"is 1 m wide, narrower than 1\.2 m"):
        run("route", layer, START="10,5", GOAL="10,9", ROBOT_WIDTH=1.2, DISTANCE=0.5)


def test_surfaces_that_no_road_has_are_warned_of(run, make_layer, listener):
    made = run("route", square(make_layer), SURFACES="asphalt, gras", START="0,0", GOAL="10,5")
    assert listener.warnings == ["No road has the surface gras: the roads have asphalt, slippery."]
    assert made["WARNING_COUNT"] == 1


@pytest.mark.parametrize("name", ["buildroadnetwork", "checkroadnetwork", "route"])
def test_a_layer_without_roads_is_refused_with_what_it_holds(run, make_layer, name):
    places = PLACES if name == "route" else {}
    empty = make_layer("roads", fields=ALL, features=[])
    with pytest.raises(QgsProcessingException, match="the layer roads has no features: choose the layer of"):
        run(name, empty, **places)
    # Its having no CRS either is not what to mend.
    nowhere = QgsVectorLayer("LineString", "roads", "memory")
    with pytest.raises(QgsProcessingException, match="the layer roads has no features: choose the layer of"):
        run(name, nowhere, **places)
    far = make_layer("roads", fields=ALL, features=[("LINESTRING(0 0, 1e12 0)", *SQUARE[0][1:])])
    said = r"no feature of the layer roads is a road: .* has a coordinate .* 100 000 km"
    with pytest.raises(QgsProcessingException, match=said):
        run(name, far, **places)


def test_areas_that_must_not_be_driven_through_are_driven_round(run, make_layer, listener):
    def metres(*areas, **how):
        names = [make_layer("keepouts", "Polygon", features=[(area,)], fields="", **how) for area in areas]
        return run("route", square(make_layer), KEEPOUTS=names, **PLACES)["METRES"]

    assert metres() == pytest.approx(19.0)
    assert metres("POLYGON((8 4, 12 4, 12 6, 8 6, 8 4))") == pytest.approx(20.0)
    assert "1 edge leads through areas to be avoided" in "".join(listener.infos)
    # Along the rim, and beside the road, nothing is driven through.
    assert metres("POLYGON((10 0, 20 0, 20 10, 10 10, 10 0))") == pytest.approx(19.0)
    assert metres("POLYGON((2 2, 8 2, 8 8, 2 8, 2 2))") == pytest.approx(19.0)
    with pytest.raises(QgsProcessingException, match="No way leads"):
        metres("POLYGON((8 4, 12 4, 12 6, 8 6, 8 4))", "POLYGON((-2 4, 2 4, 2 6, -2 6, -2 4))")


def test_fastest_differs_from_shortest(run, make_layer):
    layer = square(make_layer, maxspeed="3.6")
    assert run("route", layer, **PLACES)["METRES"] == pytest.approx(19.0)
    fastest = run("route", layer, BY="fastest", **PLACES)
    assert (fastest["METRES"], fastest["SECONDS"]) == pytest.approx((21.0, 3.0))


def test_places_in_another_crs_are_found(run, make_layer):
    layer = make_layer("roads", features=[("LINESTRING(640000 5195000, 640100 5195000)", 1)])
    made = run(
        "route", layer, START="640000,5195000 [EPSG:32633]", GOAL="16.8404,46.8914 [EPSG:4326]", DISTANCE=999
    )
    assert 0 < made["METRES"] <= 100


def test_corners_that_the_robot_cannot_drive_are_named(run, make_layer, listener):
    made = run("route", square(make_layer), TURNING_RADIUS=20, **PLACES)
    assert made["TIGHT_COUNT"] == 1
    assert "The corner at (10.00, 0.00) is tighter than the robot turns." in listener.warnings


@pytest.mark.parametrize("engine", ["contraction", "scipy", "qgis", "plain"])
def test_every_engine_is_there_and_named(run, make_layer, engine):
    made = run("route", square(make_layer), ENGINE=engine, **PLACES)
    assert made["METRES"] == pytest.approx(19.0)
    names = {"contraction": "RoutingKit", "scipy": "SciPy", "qgis": "QgsGraphAnalyzer", "plain": "Python"}
    assert names[engine] in made["ENGINE_USED"]


def test_qgis_finds_what_the_plain_search_finds(qgis_app):
    import numpy as np

    random = np.random.default_rng(3)
    lines = [random.uniform(0, 100, (3, 2)) for _ in range(15)]
    network = build_network(centrelines(lines, direction=random.integers(-1, 2, 15)))
    plain = Router(network, "plain")
    of_qgis = Router(network, lambda graph: lambda costs: GraphEngine(graph, costs))
    found = 0
    for number in range(60):
        if number == 30:
            plain.close(range(0, len(network), 7))
            of_qgis.close(range(0, len(network), 7))
        a, b = random.uniform(0, 100, (2, 2))
        try:
            wanted = plain.route(tuple(a), tuple(b), reach=100.0).metres
        except NoRouteError:
            with pytest.raises(NoRouteError):
                of_qgis.route(tuple(a), tuple(b), reach=100.0)
            continue
        found += 1
        assert of_qgis.route(tuple(a), tuple(b), reach=100.0).metres == pytest.approx(wanted, abs=1e-9)
    assert found > 10


def test_a_cancel_leaves_nothing(run, make_layer, cancels_at):
    assert run("buildroadnetwork", square(make_layer), feedback=cancels_at(0)) == {}


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("buildroadnetwork", {}),
        ("buildroadnetwork", {"REPAIR": True}),
        ("checkroadnetwork", {}),
        ("route", PLACES),
        ("route", {**PLACES, "REPAIR": True}),
    ],
)
def test_a_cancel_while_the_network_is_made_ends_it_there(
    run, make_layer, listener, monkeypatch, name, given
):
    meetings = noding._meetings

    def while_cancelled(roads, ask):
        listener.cancel()
        return meetings(roads, ask)

    def never(*roads):
        raise AssertionError("went on after the cancel")

    monkeypatch.setattr(noding, "_meetings", while_cancelled)
    monkeypatch.setattr(noding, "_split", never)
    assert run(name, square(make_layer), **given) == {}


@pytest.mark.parametrize("name", ["buildroadnetwork", "checkroadnetwork", "route"])
def test_the_toolbox_finds_help_and_icon(provider, root, name):
    algorithm = provider.algorithm(name)
    assert algorithm.group() == "Roads"
    assert len(algorithm.shortHelpString()) > 300
    assert (root / "resources" / "icons" / FindRoute.ICON).is_file()
    assert not algorithm.icon().isNull()


def test_a_script_builds_checks_and_finds_ways_on_the_sample_site(by_words, root, tmp_path):
    roads = f"ROADS={root}/resources/sample_site/site.gpkg|layername=road_centrelines"
    built = by_words(
        "run", "fleet:buildroadnetwork", "--", roads, f"EDGES={tmp_path}/e.gpkg", f"NODES={tmp_path}/n.gpkg"
    )
    assert built.status == 0, built.said
    assert (built.result("EDGE_COUNT"), built.result("NODE_COUNT"), built.result("PART_COUNT")) == (38, 30, 1)
    checked = by_words("run", "fleet:checkroadnetwork", "--", roads, f"FINDINGS={tmp_path}/f.gpkg")
    assert checked.status == 0, checked.said
    assert (checked.result("FINDING_COUNT"), checked.result("DEAD_END_COUNT")) == (4, 4)
    places = ("START=640430,5193530 [EPSG:32633]", "GOAL=640600,5193570 [EPSG:32633]")
    files = (f"ROUTE={tmp_path}/r.gpkg", f"PATH={tmp_path}/p.gpkg")
    found = by_words("run", "fleet:route", "--", roads, *places, *files)
    assert found.status == 0, found.said
    assert found.result("METRES") == pytest.approx(199.751, abs=0.001)


def test_a_route_and_its_path_are_told_apart_when_they_are_opened(root, qgis_app):
    layer = QgsVectorLayer("LineString", "line", "memory")

    def looks(output):
        layer.loadNamedStyle(str(root / "resources" / "styles" / FindRoute.STYLES[output]))
        symbol = layer.renderer().symbol()
        return symbol.width(), symbol.symbolLayer(0).color().alpha()

    (wide, pale), (thin, full) = looks("ROUTE"), looks("PATH")
    assert wide > 3 * thin
    assert pale < full == 255
