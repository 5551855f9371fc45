"""The site frame that a project carries in its variables, so that it need not be typed for each export."""

from __future__ import annotations

import math

from qgis.core import QgsCoordinateReferenceSystem, QgsProject

from ...robot_bridge.sites.frame import SiteFrame

CRS_VARIABLE = "fleet_site_crs"
ORIGIN_VARIABLES = ("fleet_origin_x", "fleet_origin_y")
ROTATION_VARIABLE = "fleet_rotation_deg"


def frame_in_project(project: QgsProject, crs: QgsCoordinateReferenceSystem) -> SiteFrame | None:
    """Return the frame in the project's variables, None unless it is whole and in ``crs``."""
    frame = own_frame(project)
    if frame is None or not crs.isValid() or QgsCoordinateReferenceSystem(frame.crs) != crs:
        return None
    return frame


def own_frame(project: QgsProject) -> SiteFrame | None:
    """Return the frame in the project's variables in whatever CRS, None unless it is whole."""
    variables = project.customVariables()
    named = str(variables.get(CRS_VARIABLE) or "")
    if not named:
        return None
    try:
        x, y = (float(variables[name]) for name in ORIGIN_VARIABLES)
        degrees = float(variables.get(ROTATION_VARIABLE) or 0.0)
    except (KeyError, TypeError, ValueError):
        return None
    return SiteFrame(named, (x, y), math.radians(degrees))
