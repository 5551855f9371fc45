"""The way from the site frame to the map and back, in any CRS."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.site_transform import SiteToMapTransform
from fleet_supervisor.plugin.ui.errors import MapTransformError
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject

YARD = 'ENGCRS["yard",EDATUM["yard"],CS[Cartesian,2],AXIS["x",east],AXIS["y",north],LENGTHUNIT["metre",1]]'
"""A CRS of its own, of which nobody knows where on the Earth it is."""


def test_a_site_crs_that_qgis_does_not_know_is_named(site):
    with pytest.raises(MapTransformError, match="EPSG:999999"):
        SiteToMapTransform(
            dataclasses.replace(site, crs="EPSG:999999"),
            QgsCoordinateReferenceSystem("EPSG:4326"),
            QgsProject.instance().transformContext(),
        )


def test_a_position_beyond_the_map_projection_is_an_error_in_words(site):
    placement = SiteToMapTransform(
        site, QgsCoordinateReferenceSystem("EPSG:3857"), QgsProject.instance().transformContext()
    )
    with pytest.raises(MapTransformError, match="Choose the site's CRS"):
        placement.to_map(np.array([(1e12, 1e12)]))


def test_on_a_map_of_which_nobody_knows_where_it_is_no_robot_is_drawn_and_no_click_counts(site):
    placement = SiteToMapTransform(
        site, QgsCoordinateReferenceSystem(YARD), QgsProject.instance().transformContext()
    )
    for look in (
        lambda: placement.to_map(np.array([(12.5, 80.25)])),
        lambda: placement.to_site(QgsPointXY(4, 5)),
    ):
        with pytest.raises(MapTransformError, match=r"yard.*nothing is known of how the two lie"):
            look()


def test_points_come_back_from_every_crs(site):
    site = dataclasses.replace(site, rotation=-0.9)
    for crs in ("EPSG:32633", "EPSG:3857", "EPSG:4326", "EPSG:23700"):
        placement = SiteToMapTransform(
            site, QgsCoordinateReferenceSystem(crs), QgsProject.instance().transformContext()
        )
        ((x, y),) = placement.to_map(np.array([(12.5, 80.25)]))
        assert placement.to_site(QgsPointXY(x, y)) == pytest.approx((12.5, 80.25), abs=0.002)
