"""Map profiles: which layers they fit, what they say of them, and what is said of a wrong file."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.layer_expressions import LayerRules, as_metres
from fleet_supervisor.plugin.layers.layer_source import obstacle_sources
from fleet_supervisor.plugin.layers.obstacle_layers import read_outlines
from fleet_supervisor.plugin.layers.roles import (
    LayerExpressions,
    LayerSetup,
    Profile,
    ProfileRule,
    find_profile,
    keep_setup,
    names_of,
    read_profile,
    shipped_profiles,
)
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.plugin.ui.errors import ProfileError
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import (
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeatureRequest,
    QgsFeedback,
    QgsProject,
    QgsProviderRegistry,
    QgsProviderSublayerDetails,
    QgsVectorLayer,
)

RULE = '[[layers]]\nnames = ["*wall*"]\nrole = "obstacle"\n'


@pytest.fixture
def profile(tmp_path):
    """Return the profile in a file of this text."""

    def read(text, name="mine.toml"):
        file = tmp_path / name
        file.write_text(text, encoding="utf-8")
        return read_profile(file)

    return read


def layer(name, kind="LineString", fields=""):
    return QgsVectorLayer(f"{kind}?crs=EPSG:32633{fields}", name, "memory")


def test_the_first_rule_that_fits_counts(qgis_app, profile):
    rules = profile(
        """
        name = "Mine"
        [[layers]]
        names = ["*Wall*", "fence?"]
        geometry = "line"
        fields = ["h"]
        role = "obstacle"
        height = '"h" * 2'
        [[layers]]
        names = ["*wall*"]
        role = "keepout"
        """
    )
    with_field = rules.setup_for(layer("Old WALLS", fields="&field=h:double"))
    assert with_field == LayerSetup("obstacle", LayerExpressions(height='"h" * 2'))
    assert rules.setup_for(layer("wall")).role == "keepout"
    assert rules.setup_for(layer("walls", "Polygon", "&field=h:double")).role == "keepout"
    assert rules.setup_for(layer("fence1", fields="&field=H:double")).role == "obstacle"
    assert rules.setup_for(layer("fence12", fields="&field=h:double")) is None


def test_what_a_layer_keeps_counts_only_where_the_profile_says_nothing(qgis_app, profile):
    rules = profile(RULE)
    wall, pond = layer("wall"), layer("pond")
    for one in (wall, pond):
        keep_setup(one, LayerSetup("keepout", LayerExpressions(height="9")))
    assert rules.setup_over(wall) == LayerSetup("obstacle")
    assert rules.setup_over(pond) == LayerSetup("keepout", LayerExpressions(height="9"))


def test_json_says_the_same_as_toml(qgis_app, profile):
    content = {"layers": [{"names": ["*wall*"], "role": "obstacle"}]}
    assert profile(json.dumps(content), "mine.json").rules == profile(RULE).rules


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name = 3\n" + RULE, "name is 3: write text in quotes"),
        ('nmae = "x"\n' + RULE, "nmae is no key of a profile: known are name, about, layers"),
        ('name = "x"', "layers is missing or empty"),
        ("layers = [3]", "layers[0] is 3: write a table"),
        (RULE + RULE.replace("obstacle", "wal"), "layers[1].role is 'wal': write one of obstacle, stairs"),
        ('[[layers]]\nrole = "obstacle"\n', "layers[0] fits no layer"),
        (RULE + 'hight = "2"\n', "layers[0].hight is no key of a profile: known are names"),
        (RULE + 'height = "2 +"\n', "layers[0].height is no QGIS expression"),
        (RULE + 'filter = "2 +"\n', "layers[0].filter is no QGIS expression"),
        (
            RULE + f'height = "{"1+" * 5500}1"\n',
            "is no QGIS expression: it has 11001 characters, more than 10000",
        ),
        ("a" + ".a" * 100_000 + " = 1", "a key has more than 32 parts"),
        ("x = " + "[" * 100_000, "nested too deeply"),
        (RULE + "height = 2\n", "layers[0].height is 2: write text in quotes"),
        (RULE + "fields = [2]\n", "layers[0].fields is [2]: write a list of texts"),
        (RULE + 'geometry = "dot"\n', "layers[0].geometry is 'dot': write one of point, line, polygon"),
        ("[[layers", "is not valid TOML"),
    ],
)
def test_what_is_wrong_is_named_with_file_and_key(qgis_app, profile, tmp_path, text, said):
    with pytest.raises(ProfileError) as error:
        profile(text)
    assert str(tmp_path / "mine.toml") in str(error.value) and said in str(error.value)


def test_a_profile_that_is_not_there_is_told_with_those_that_are(qgis_app):
    with pytest.raises(ProfileError, match=r"give the path of a file, or one of openstreetmap, upc_campus"):
        read_profile(find_profile("openstretmap"))


@pytest.mark.parametrize("file", shipped_profiles(), ids=lambda file: file.stem)
def test_a_shipped_profile_is_right_and_found_by_its_name(qgis_app, file):
    assert find_profile(file.stem) == file
    assert read_profile(file).about


def evaluated(source, what, file="openstreetmap", most=-1):
    """Return the values that a shipped profile gives to the first features of a real layer."""
    setup = read_profile(find_profile(file)).setup_for(source)
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(source))
    rules = LayerRules(source.name(), source.fields(), context)
    rule = rules.needed_rule(what, getattr(setup.expressions, what))
    values, notes = [], []
    for feature in source.getFeatures(QgsFeatureRequest().setLimit(most)):
        rules.at(feature)
        values.append(rules.value(what, rule, notes))
    assert notes == []
    return values


def test_openstreetmap_knows_heights_and_widths_of_helsinki(qgis_app, data):
    city = data / "osm" / "helsinki_centre_utm35n.gpkg"
    buildings, barriers, roads = (
        QgsVectorLayer(f"{city}|layername={name}", name, "ogr") for name in ("buildings", "barriers", "roads")
    )
    levels = [f["building_levels"] for f in buildings.getFeatures()]
    heights = evaluated(buildings, "estimate")
    told = [
        (float(level), h) for level, h in zip(levels, heights, strict=True) if level and h == 3 * float(level)
    ]
    assert len(told) > 100
    assert {1.5, 2.0, 0.15, "0.5 m"} <= {*evaluated(barriers, "height"), *evaluated(barriers, "estimate")}
    widths = [as_metres(width) for width in evaluated(roads, "width") if width]
    assert len(widths) > 2000 and min(widths) > 0.5 and max(widths) < 40.0


@pytest.mark.parametrize("tags", ["&field=height:string", "&field=building:string", ""])
@pytest.mark.parametrize(
    ("name", "kind", "role"), [("my buildings", "Polygon", "obstacle"), ("furniture", "Point", "furniture")]
)
def test_openstreetmap_needs_none_of_its_fields(qgis_app, name, kind, role, tags):
    setup = read_profile(find_profile("openstreetmap")).setup_for(layer(name, kind, tags))
    assert setup.role == role
    for text in vars(setup.expressions).values():
        assert QgsExpression(text).referencedColumns() <= {QgsFeatureRequest.ALL_ATTRIBUTES}


@pytest.fixture
def read_by_profile(qgis_app):
    """Read layers of a file, together in the project, as a profile says; by the layers' names."""
    project = QgsProject.instance()

    def run(file, profile, *names):
        layers = [QgsVectorLayer(f"{file}|layername={name}", name, "ogr") for name in names]
        project.addMapLayers(layers)
        site = SiteGeoreference(
            layers[0].crs(), SiteFrame("EPSG:32635", (0.0, 0.0)), project.transformContext(), True
        )
        setups = read_profile(find_profile(profile)).setup_over
        context = QgsExpressionContext()
        return {
            one.name(): read_outlines(
                obstacle_sources([one], LayerExpressions(), context, setups), site, None, 3.0, QgsFeedback()
            )
            for one in layers
        }

    yield run
    project.clear()


def test_openstreetmap_takes_of_points_what_stands_in_the_way(read_by_profile, data):
    city = data / "osm" / "helsinki_centre_utm35n.gpkg"
    reading = read_by_profile(city, "openstreetmap", "furniture")["furniture"]
    counts = Counter(row.semantics for row in reading.rows)
    assert (counts["bench"], counts["waste_basket"], counts["street_lamp"]) == (162, 36, 586)
    assert not {"restaurant", "crossing", "traffic_signals", "gate"} & counts.keys()
    assert reading.warnings == []
    benches = [row for row in reading.rows if row.semantics == "bench"]
    assert all(len(row.points) == 5 and row.height == 0.9 for row in benches)


@pytest.mark.parametrize(
    ("way", "degrees"),
    [("90", 90), ("NE", 45), ("NNW", 337.5), ("XX", None), ("forward", None), (None, None)],
)
def test_openstreetmap_turns_furniture_as_its_direction_says(qgis_app, make_layer, way, degrees):
    tags = f'"ref"=>"3","direction"=>"{way}"' if way else None
    fields = "&field=direction:string&field=other_tags:string"
    for values in ((way, None), (None, tags)):
        things = make_layer("furniture", "Point", fields, [("Point(0 0)", *values)])
        (value,) = evaluated(things, "rotation")
        assert value == degrees


def test_the_campus_has_ramps_among_its_ground_and_walls_that_begin_above_it(read_by_profile, data):
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    names = ("walls", "furniture", "ground_surfaces")
    read = read_by_profile(file, "upc_campus_nord", *names)
    ramps = read["ground_surfaces"].rows
    assert len({row.source for row in ramps}) == 39
    assert {row.shape_type for row in ramps} == {ShapeType.RAMP}
    bases = np.array([row.base for row in read["walls"].rows])
    # Of 1618 faces most stand on the ground; those of storeys above begin metres over it, none below it.
    assert bases.min() == 0.0 and np.median(bases) == 0.0
    assert 100 < (bases > 2.5).sum() < 300
    assert all(reading.warnings == [] for reading in read.values())


def test_without_its_ground_the_campus_stands_on_it(read_by_profile, data):
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    reading = read_by_profile(file, "upc_campus_nord", "walls")["walls"]
    assert {row.base for row in reading.rows} == {0.0} and reading.warnings == []


def test_the_profile_in_the_guide_is_one(qgis_app, profile, root):
    guide = (root / "docs" / "site-preparation.md").read_text(encoding="utf-8")
    lines = guide.partition('    name = "Our campus"')
    example = "\n".join(
        line[4:] for line in "".join(lines[1:]).splitlines() if line[:4].isspace() or not line
    )
    ours = profile(example.partition("qgis_process")[0])
    assert ours.name == "Our campus"
    assert ours.setup_for(layer("Sheds", "Polygon", "&field=roof:double")).role == "obstacle"
    assert ours.setup_for(layer("roads")).expressions.width == '"lanes" * 3.25'


CAMPUS_LAYERS = {
    "buildings": "obstacle",
    "walls": "obstacle",
    "step_edges": "stairs",
    "furniture": "furniture",
    "ground_surfaces": "ramp",
}


@pytest.fixture
def browsed_campus(qgis_app, data):
    """The campus as QGIS's browser adds it: each layer is called after its file, too."""
    project = QgsProject.instance()
    file = data / "upc_campus_nord" / "upc_campus_nord_nominal_epsg25831.gpkg"
    layers = {}
    for found in QgsProviderRegistry.instance().querySublayers(str(file)):
        options = QgsProviderSublayerDetails.LayerOptions(project.transformContext())
        made = found.toLayer(options)
        # As QgsAppLayerHandling names layers of a file that has several.
        made.setName(f"{file.stem} — {found.name()}")
        layers[found.name()] = made
    project.addMapLayers(list(layers.values()))
    yield layers
    project.clear()


def test_layers_are_known_by_the_name_in_their_source(browsed_campus):
    campus = read_profile(find_profile("upc_campus_nord"))
    assert all(" — " in layer.name() for layer in browsed_campus.values())
    found = {name: campus.setup_for(layer) for name, layer in browsed_campus.items()}
    assert {name: setup.role for name, setup in found.items() if setup is not None} == CAMPUS_LAYERS
    # A name that somebody gave it in the project counts as before.
    walls = browsed_campus["walls"]
    mine = Profile("", "", (ProfileRule(("our walls",), (), "", LayerSetup("keepout")),))
    assert mine.setup_for(walls) is None
    walls.setName("Our walls")
    assert mine.setup_for(walls).role == "keepout" and campus.setup_for(walls).role == "obstacle"


@pytest.mark.parametrize("name", ["walls", "furniture"])
def test_the_campus_stands_on_its_ground_whatever_the_layers_are_called(browsed_campus, name):
    """The layer of the ground is found beside them: without it everything would stand at height 0."""
    layer = browsed_campus[name]
    as_browsed = evaluated(layer, "base", "upc_campus_nord", 300)
    assert sum(base is not None for base in as_browsed) > 50
    for inside, one in browsed_campus.items():
        one.setName(inside)
    assert evaluated(layer, "base", "upc_campus_nord", 300) == as_browsed


def test_a_layer_without_a_source_of_several_goes_by_what_it_is(qgis_app, tmp_path):
    file = tmp_path / "walls.geojson"
    file.write_text('{"type": "FeatureCollection", "features": []}', encoding="utf-8")
    assert names_of(QgsVectorLayer(str(file), "Mine", "ogr")) == ["Mine", "walls"]
    assert names_of(layer("Mine")) == ["Mine"]
    assert names_of(QgsVectorLayer("nowhere.gpkg|layername=walls", "nowhere", "ogr")) == ["walls"]
