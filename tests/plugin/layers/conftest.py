"""Layers read into outlines."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.layer_source import obstacle_sources
from fleet_supervisor.plugin.layers.obstacle_layers import read_outlines
from fleet_supervisor.plugin.layers.roles import LayerExpressions
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsExpressionContext,
    QgsFeedback,
)


@pytest.fixture
def read(qgis_app):
    """Read layers into a :class:`Reading`; the site frame is EPSG:32633 itself unless told otherwise."""

    def run(*layers, crs="EPSG:32633", origin=(0.0, 0.0), rotation=0.0, local=False, feedback=None, **more):
        site = SiteGeoreference(
            QgsCoordinateReferenceSystem(crs),
            SiteFrame(crs, origin, rotation),
            QgsCoordinateTransformContext(),
            local,
        )
        general = more.get("general", LayerExpressions())
        sources = obstacle_sources(layers, general, QgsExpressionContext())
        window = more.get("window", (-1e7, -1e7, 1e7, 1e7))
        return read_outlines(
            sources, site, window, more.get("default_height", 3.0), feedback or QgsFeedback()
        )

    return run
