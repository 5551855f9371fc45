"""Map profiles: which layers they fit, what they say of them, and what is said of a wrong file."""

from __future__ import annotations

import json

import pytest
from fleet_supervisor.plugin.sites.errors import ProfileError
from fleet_supervisor.plugin.sites.profile_file import find_profile, read_profile, shipped_profiles
from fleet_supervisor.plugin.sites.roles import LayerExpressions, LayerSetup, keep_setup
from qgis.core import (
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsFeatureRequest,
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


def evaluated(source, what, file="openstreetmap"):
    """Return the values that a shipped profile gives to the features of a real layer."""
    setup = read_profile(find_profile(file)).setup_for(source)
    expression = QgsExpression(getattr(setup.expressions, what))
    context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(source))
    values = []
    for feature in source.getFeatures():
        context.setFeature(feature)
        values.append(expression.evaluate(context))
        assert not expression.hasEvalError(), expression.evalErrorString()
    return values


def test_openstreetmap_knows_heights_and_widths_of_helsinki(qgis_app, data):
    city = data / "osm" / "helsinki_centre_utm35n.gpkg"
    buildings, barriers, roads = (
        QgsVectorLayer(f"{city}|layername={name}", name, "ogr") for name in ("buildings", "barriers", "roads")
    )
    levels = [f["building_levels"] for f in buildings.getFeatures()]
    heights = evaluated(buildings, "height")
    told = [
        (float(level), h) for level, h in zip(levels, heights, strict=True) if level and h == 3 * float(level)
    ]
    assert len(told) > 100
    assert {1.5, 2.0, 0.15, "0.5 m"} <= set(evaluated(barriers, "height"))
    widths = [width for width in evaluated(roads, "width") if width]
    assert len(widths) > 2000 and min(widths) > 0.5 and max(widths) < 40.0


@pytest.mark.parametrize("tags", ["&field=height:string", "&field=building:string", ""])
def test_openstreetmap_needs_none_of_its_fields(qgis_app, tags):
    setup = read_profile(find_profile("openstreetmap")).setup_for(layer("my buildings", "Polygon", tags))
    assert setup.role == "obstacle"
    columns = QgsExpression(setup.expressions.height).referencedColumns()
    assert columns <= {QgsFeatureRequest.ALL_ATTRIBUTES}


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
