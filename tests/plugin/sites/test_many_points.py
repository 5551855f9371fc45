"""Many coordinates through one transform."""

from __future__ import annotations

import numpy as np
from fleet_supervisor.plugin.sites import many_points
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsPointXY,
    QgsProject,
)

PLACES = np.array([(15.0, 47.0), (1e5, 1e5), (15.001, 47.001), (15.0, 91.0)])
THERE = [True, False, True, False]


def way(qgis_app):
    ends = (QgsCoordinateReferenceSystem(name) for name in ("EPSG:4326", "EPSG:32633"))
    return QgsCoordinateTransform(*ends, QgsProject.instance())


def test_those_with_a_place_are_moved_and_the_others_are_not_finite(qgis_app):
    moved = many_points.moved(PLACES, way(qgis_app))
    assert np.isfinite(moved).all(axis=1).tolist() == THERE
    for (x, y), found in zip(PLACES[THERE], moved[THERE], strict=True):
        point = way(qgis_app).transform(QgsPointXY(x, y))
        np.testing.assert_allclose(found, (point.x(), point.y()), atol=1e-9)


def test_where_qgis_refuses_them_together_they_are_moved_one_by_one(qgis_app, monkeypatch):
    together = many_points.moved(PLACES, way(qgis_app))

    def refused(_xy, _transform):
        raise QgsCsException("no place")

    monkeypatch.setattr(many_points, "moved_together", refused)
    alone = many_points.moved(PLACES, way(qgis_app))
    assert np.isfinite(alone).all(axis=1).tolist() == THERE
    np.testing.assert_allclose(alone[THERE], together[THERE], atol=1e-6)


def test_one_point_and_none(qgis_app):
    assert many_points.moved(PLACES[:1], way(qgis_app)).shape == (1, 2)
    assert many_points.moved(PLACES[:0], way(qgis_app)).shape == (0, 2)
