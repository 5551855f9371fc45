"""A layer's filter says which of its features count, whatever reads them."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.layer_source import obstacle_sources
from fleet_supervisor.plugin.layers.road_layers import check_ground_sources, read_areas, read_centrelines
from fleet_supervisor.plugin.layers.roles import (
    KEEPOUT,
    ROAD_CENTRELINE,
    ROAD_SURFACE,
    LayerExpressions,
    set_expressions,
)
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.plugin.ui.errors import ExpressionError
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsExpressionContext,
    QgsFeedback,
)

LINE = "LineString(0 0, 4 0)"
AREA = "Polygon((0 0, 10 0, 10 10, 0 10, 0 0))"
KIND = "&field=kind:string"


@pytest.fixture
def filtered(make_layer):
    """Return a layer whose filter is ``text``."""

    def make(text, *more, **layer):
        made = make_layer(*more, **{"fields": KIND, **layer})
        set_expressions(made, LayerExpressions(filter=text))
        return made

    return make


def sources(layer):
    return obstacle_sources([layer], LayerExpressions(), QgsExpressionContext())


SITE = ("EPSG:32633", (0.0, 0.0))


def placing():
    crs = QgsCoordinateReferenceSystem(SITE[0])
    return SiteGeoreference(crs, SiteFrame(*SITE), QgsCoordinateTransformContext())


def test_only_features_that_the_filter_is_true_of_are_read(filtered, read):
    kinds = ["bench", "tree", NULL, "bench", ""]
    reading = read(filtered("\"kind\" = 'bench'", features=[(LINE, kind) for kind in kinds]))
    assert [row.source for row in reading.rows] == ["walls:1", "walls:4"]
    assert reading.warnings == ["Layer walls: 2 heights are not known and estimated as 3 m (features 1, 4)"]


def test_nothing_is_said_of_features_that_do_not_count(filtered, read):
    reading = read(
        filtered("\"kind\" = 'bench'", features=[(None, "tree"), ("LineString(1 1, 1 1)", "tree")])
    )
    assert (reading.rows, reading.warnings) == ([], [])


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("true", 1),
        ("1", 1),
        ("'yes'", 1),
        ("false", 0),
        ("0", 0),
        ("'no'", 0),
        ("NULL", 0),
        ("", 1),
        (" ", 1),
    ],
)
def test_what_is_true_of_a_feature(filtered, read, text, kept):
    assert len(read(filtered(text, features=[(LINE, "bench")])).rows) == kept


def test_a_filter_that_is_neither_true_nor_false_leaves_the_feature_out_and_names_it(filtered, read):
    reading = read(filtered('"kind"', features=[(LINE, "bench"), (LINE, "true")]))
    assert [row.source for row in reading.rows] == ["walls:2"]
    assert reading.warnings[0] == (
        "Layer walls, feature 1: its filter gives 'bench', which is neither true nor false; it is left out"
    )


def test_a_filter_that_fails_on_a_feature_leaves_it_out_and_names_it(filtered, read):
    reading = read(filtered('to_int("kind") > 1', features=[(LINE, "2"), (LINE, "many")]))
    assert [row.source for row in reading.rows] == ["walls:1"]
    assert reading.warnings[0].startswith(
        "Layer walls, feature 2: the filter expression fails: Cannot convert"
    )
    assert reading.warnings[0].endswith("; it is left out")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('"kind" =', r"The filter expression '\"kind\" =' for the layer walls is not one: .*Correct it"),
        (
            "\"amenity\" = 'bench'",
            r"The filter expression .* for the layer walls reads the field amenity, which",
        ),
    ],
)
def test_a_filter_that_cannot_be_used_is_refused_with_layer_and_expression(filtered, read, text, said):
    with pytest.raises(ExpressionError, match=said):
        read(filtered(text, features=[(None,)]))


def test_a_field_that_may_be_missing_can_be_asked_for(filtered, read):
    reading = read(filtered("attribute('amenity') = 'bench'", features=[(LINE, "bench")]))
    assert (reading.rows, reading.warnings) == ([], [])


def test_roads_and_areas_are_filtered(filtered):
    roads = filtered("\"kind\" = 'a'", "roads", features=[(LINE, "a"), (LINE, "b"), (None, "b")])
    centrelines = read_centrelines(sources(roads), placing(), 3.5, QgsFeedback())
    assert len(centrelines.items) == 1
    width, direction = centrelines.warnings
    assert "its roads is not known and taken as" in direction and "one-way" in width
    ponds = filtered("\"kind\" = 'a'", "ponds", "Polygon", features=[(AREA, "a"), (AREA, "b"), (AREA, "a")])
    assert len(read_areas(sources(ponds), placing(), KEEPOUT, QgsFeedback()).items) == 2


@pytest.mark.parametrize("role", [ROAD_CENTRELINE, ROAD_SURFACE, KEEPOUT])
def test_a_wrong_filter_of_roads_and_areas_is_refused_before_they_are_read(filtered, role):
    with pytest.raises(ExpressionError, match=r"filter expression 'kind is' for the layer ground"):
        check_ground_sources(sources(filtered("kind is", "ground")), placing(), role)
