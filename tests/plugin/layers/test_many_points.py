"""Many coordinates through one transform."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.layers import site_transform
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsPointXY,
    QgsProject,
)

PLACES = np.array([(15.0, 47.0), (1e5, 1e5), (15.001, 47.001), (15.0, 91.0)])
THERE = [True, False, True, False]


YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""


def way(qgis_app):
    ends = (QgsCoordinateReferenceSystem(name) for name in ("EPSG:4326", "EPSG:32633"))
    return QgsCoordinateTransform(*ends, QgsProject.instance())


def test_those_with_a_place_are_moved_and_the_others_are_not_finite(qgis_app):
    moved = site_transform.transform_points_or_nan(PLACES, way(qgis_app))
    assert np.isfinite(moved).all(axis=1).tolist() == THERE
    for (x, y), found in zip(PLACES[THERE], moved[THERE], strict=True):
        point = way(qgis_app).transform(QgsPointXY(x, y))
        np.testing.assert_allclose(found, (point.x(), point.y()), atol=1e-9)


def test_where_qgis_refuses_them_together_they_are_moved_in_smaller_and_smaller_parts(qgis_app, monkeypatch):
    places = np.tile(PLACES, (5, 1))
    together = site_transform.transform_points_or_nan(places, way(qgis_app))
    assert np.isfinite(together).all(axis=1).tolist() == THERE * 5
    whole = site_transform.transform_points

    def strict(xy, transform):
        moved = whole(xy, transform)
        if not np.isfinite(moved).all():
            raise QgsCsException("no place")
        return moved

    monkeypatch.setattr(site_transform, "transform_points", strict)
    apart = site_transform.transform_points_or_nan(places, way(qgis_app))
    np.testing.assert_allclose(apart, together, atol=1e-6)


def test_of_a_thing_one_point_without_a_place_leaves_out_all_and_no_other_thing(qgis_app):
    things = np.stack([PLACES[[0, 1]], PLACES[[0, 2]]])
    moved = site_transform.transform_points_or_nan(things, way(qgis_app))
    assert np.isfinite(moved).all(axis=2).tolist() == [[False, False], [True, True]]


def test_one_point_and_none(qgis_app):
    assert site_transform.transform_points_or_nan(PLACES[:1], way(qgis_app)).shape == (1, 2)
    assert site_transform.transform_points_or_nan(PLACES[:0], way(qgis_app)).shape == (0, 2)


def test_degrees_do_not_become_the_metres_of_a_crs_of_which_nothing_is_known(qgis_app):
    ends = (QgsCoordinateReferenceSystem("EPSG:4326"), QgsCoordinateReferenceSystem(YARD))
    nowhere = QgsCoordinateTransform(*ends, QgsProject.instance())
    with pytest.raises(QgsCsException):
        site_transform.transform_points(PLACES, nowhere)
    assert not np.isfinite(site_transform.transform_points_or_nan(PLACES, nowhere)).any()


def test_where_an_end_has_no_crs_places_stay_as_they_are(qgis_app):
    ends = (QgsCoordinateReferenceSystem("EPSG:4326"), QgsCoordinateReferenceSystem())
    np.testing.assert_array_equal(
        site_transform.transform_points(PLACES, QgsCoordinateTransform(*ends, QgsProject.instance())), PLACES
    )
