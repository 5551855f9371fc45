"""The CRS that carries the site, and the site frame of a project."""

from __future__ import annotations

import math
from collections.abc import Sequence

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProject,
    QgsUnitTypes,
)

from ...robot_bridge.core.sites.frame import SiteFrame, utm_zone_of
from ..ui.errors import SiteCrsError
from ..ui.language import tr

# --- The CRS that carries the site, and CRSs that cannot ---


def site_crs_for(
    chosen: QgsCoordinateReferenceSystem,
    project: QgsCoordinateReferenceSystem,
    layers: Sequence[QgsCoordinateReferenceSystem],
) -> QgsCoordinateReferenceSystem:
    """Return the CRS that carries the site: ``chosen``, else the layers' own or the project's.

    The layers' own wins over the project's when it is one engineering CRS, which has no transform to others,
    and where there is no project. The result is invalid when no CRS is known at all.

    :raises SiteCrsError: when that CRS cannot carry a site, or the layers have several and nothing chooses.
    """
    own = [crs for crs in layers if crs.isValid()]
    shared = own[0] if own and all(crs == own[0] for crs in own) else QgsCoordinateReferenceSystem()
    if chosen.isValid():
        crs = chosen
    elif project.isValid() and not is_engineering(shared):
        crs = project
    elif not shared.isValid() and not all(map(is_engineering, own)):
        raise SiteCrsError(_several(own))
    else:
        crs = shared
    if crs.isValid():
        check_site_crs(crs)
    return crs


def check_site_crs(crs: QgsCoordinateReferenceSystem) -> None:
    """Raise :class:`SiteCrsError` unless ``crs`` is a plane in true metres.

    Projected CRSs in metres qualify, except Mercator ones such as EPSG:3857; so does an engineering CRS in
    metres, which is a site frame already.
    """
    named = tr("The CRS {crs} cannot carry a site", crs=crs_name(crs))
    if crs.isGeographic() or crs.projectionAcronym() == "geocent":
        raise SiteCrsError(
            tr(
                "{named}: its coordinates are not metres on a plane. Choose a projected CRS such as the "
                "local UTM zone{suggestion}.",
                named=named,
                suggestion=_suggestion(crs),
            )
        )
    if is_mercator(crs):
        raise SiteCrsError(
            tr(
                "{named}: its metres are not metres; 1 m on the ground is 1.56 m there at latitude 50°. "
                "Choose the local UTM zone, such as EPSG:32633 for 12°E to 18°E.",
                named=named,
            )
        )
    if crs.mapUnits() != QgsUnitTypes.DistanceUnit.DistanceMeters:
        raise SiteCrsError(
            tr(
                "{named}: its unit is {unit}, and robots speak metres. Choose a CRS in metres such as "
                "the local UTM zone{suggestion}.",
                named=named,
                unit=QgsUnitTypes.toString(crs.mapUnits()),
                suggestion=_suggestion(crs),
            )
        )


def is_mercator(crs: QgsCoordinateReferenceSystem) -> bool:
    """Return whether ``crs`` is a Mercator one, such as EPSG:3857: its metres are not true on the ground."""
    return crs.projectionAcronym() in ("merc", "webmerc")


def is_engineering(crs: QgsCoordinateReferenceSystem) -> bool:
    """Return whether ``crs`` is local by definition, with no known place on the Earth."""
    wkt = crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED)
    return wkt.startswith(("ENGCRS", "ENGINEERINGCRS", "LOCAL_CS"))


def stated_crs(crs: QgsCoordinateReferenceSystem) -> QgsCoordinateReferenceSystem:
    """Return ``crs``, invalid where it only states that there is none.

    A GeoPackage without a CRS comes as one named "Undefined SRS" or the like: a local one in metres, or one
    in degrees.
    """
    undefined = crs.description().startswith("Undefined ") and not crs.authid()
    return QgsCoordinateReferenceSystem() if undefined else crs


def crs_name(crs: QgsCoordinateReferenceSystem) -> str:
    """Return the authority's code and the name of ``crs``, as far as available."""
    if crs.authid() and crs.description():
        return f"{crs.authid()} ({crs.description()})"
    return crs.authid() or crs.description() or tr("without a name")


def _several(own: Sequence[QgsCoordinateReferenceSystem]) -> str:
    names = ", ".join(dict.fromkeys(crs_name(crs) for crs in own))
    return tr(
        "The layers are in different CRSs ({names}), and nothing says which is the site's: give SITE_CRS, "
        "or set the project's CRS.",
        names=names,
    )


def _suggestion(crs: QgsCoordinateReferenceSystem) -> str:
    """Return ``", EPSG:..."`` for the UTM zone in the middle of the CRS's area, when that area is small."""
    area = crs.bounds()
    if area.isEmpty() or area.width() > 30.0:
        return tr(" (EPSG:326xx north, EPSG:327xx south of the equator)")
    return f", {utm_zone_of(area.center().x(), area.center().y())}"


# --- The site frame stored in a project's variables, so that it need not be entered for each export

CRS_VARIABLE = "fleet_site_crs"
ORIGIN_VARIABLES = ("fleet_origin_x", "fleet_origin_y")
ROTATION_VARIABLE = "fleet_rotation_deg"


def frame_in_project(project: QgsProject, crs: QgsCoordinateReferenceSystem) -> SiteFrame | None:
    """Return the frame in the project's variables, None unless it is complete and in ``crs``."""
    frame = own_frame(project)
    if frame is None or not crs.isValid() or QgsCoordinateReferenceSystem(frame.crs) != crs:
        return None
    return frame


def own_frame(project: QgsProject) -> SiteFrame | None:
    """Return the frame in the project's variables in whatever CRS, None unless it is complete."""
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
