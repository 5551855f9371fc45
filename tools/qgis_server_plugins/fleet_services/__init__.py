"""Refuses what QGIS Server does besides publishing one project: other files, other servers, expressions.

QGIS Server takes from any client the path of another project (MAP), addresses to fetch (SLD, EXTERNAL_WMS,
symbols with pictures) and expressions, which read the server's environment and files. Not all of that can be
turned off by settings. Requests of WMS, WMTS and WFS may therefore have the parameters of ``PARAMETERS`` and
nothing else. It also says where the layers of the fleet lie.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping

from qgis.core import QgsRectangle
from qgis.server import QgsConfigCache, QgsServerException, QgsServerFilter, QgsServerInterface

PARAMETERS = {
    "wms": "bbox bgcolor crs dpi exceptions feature_count fi_line_tolerance fi_point_tolerance "
    "fi_polygon_tolerance filter format format_options height i info_format j layer layers map_resolution "
    "opacities query_layers request service sld_version srs style styles tiled time transparent version "
    "width wmtver x y",
    "wmts": "format i infoformat j layer request service style tilecol tilematrix tilematrixset tilerow "
    "version",
    "wfs": "acceptversions bbox count exceptions featureid filter geometryname maxfeatures namespace "
    "namespaces outputformat propertyname request resulttype service sortby srsname startindex typename "
    "typenames version",
}
"""The parameters of each service."""
REQUESTS = {
    "wms": "getcapabilities getmap getfeatureinfo getlegendgraphic getlegendgraphics describelayer "
    "getschemaextension",
    "wmts": "getcapabilities gettile getfeatureinfo",
    "wfs": "getcapabilities describefeaturetype getfeature",
}
"""What each service is asked for. What writes, prints, or says how the project is made is not among them."""
FEATURES = "/wfs3"
"""Where OGC API Features is. Its parameters are names of fields, too, which it compares with the layer's."""
BAD_REQUEST = "Bad request error"
"""What it calls a wrong request in its errors."""
REPEATED = ("layers", "layer", "query_layers")
"""Where a layer may be named once: it is painted as often as it is named, and all others wait meanwhile."""
NAMES = {
    **dict.fromkeys(("typename", "typenames"), re.compile(r"[\w ,:.()-]*")),
    "propertyname": re.compile(r"[\w ,:.*()-]*"),
    "sortby": re.compile(r"[\w ,\"]*"),
}
"""Lists of names: what QGIS Server sorts by it takes for expressions."""
MOST_LETTERS = 4000
MOST = {"width": 4096, "height": 4096, "dpi": 1200, "map_resolution": 1200}
"""QGIS Server bounds the picture of a map only; GetFeatureInfo makes one, too."""
NUMBER = re.compile(r"[0-9]+(\.[0-9]+)?")
FIELD = r"""\"[^'";\\\x00-\x1f]*"(?!\s*\()"""
TEXT = r"""'[^'";\\\x00-\x1f]*'"""
WORD = rf"(?:[\s0-9(),=<>]|\.(?=[0-9])|!=|-(?=[0-9])|{TEXT}|{FIELD}|(?:AND|OR|NOT|IN|IS|NULL|I?LIKE)\b)"
CONDITION = rf"""[^:;<'"]+:{WORD}+"""
CONDITIONS = re.compile(rf"{CONDITION}(;{CONDITION})*;?", re.IGNORECASE | re.ASCII)
"""FILTER of WMS, which goes to the database. The check of QGIS Server takes for a text what has quotes at
both ends, such as 'a'||f()||'b', and for a field a function whose name has quotes. PostgreSQL calls functions
by a point, too: "robots"."row_to_json". At a NUL the statement is cut."""
XML = re.compile(r"\s*\(?<.*>\)?\s*", re.DOTALL)


class RefusedError(Exception):
    """Why a request is not answered."""


class RequestGuard(QgsServerFilter):
    """Stands before all services."""

    def requestReady(self) -> None:  # noqa: N802 # QGIS
        """Answer what :func:`check` refuses with 400, and the reason."""
        handler = self.serverInterface().requestHandler()
        try:
            check(handler.path(), handler.parameterMap(), bytes(handler.data()))
        except RefusedError as refusal:
            handler.setServiceException(QgsServerException(str(refusal), 400))
            if is_of_features(handler.path(), handler.parameterMap()):
                handler.clearBody()
                handler.setResponseHeader("Content-Type", "application/json")
                handler.appendBody(json.dumps({"code": BAD_REQUEST, "description": str(refusal)}).encode())
        else:
            place_layers()


def check(path: str, parameters: Mapping[str, str], body: bytes) -> None:
    """Raise :class:`RefusedError` for a request that is none of those served."""
    if body:
        raise RefusedError("Requests have no body here: use GET, with parameters in the address.")
    given = {name.lower(): value for name, value in parameters.items()}
    if "service" not in given:
        _check_features(path, given)
        return
    service, request = given["service"].lower(), given.get("request", "").lower()
    if service not in PARAMETERS:
        raise RefusedError("SERVICE is one of WMS, WMTS and WFS.")
    if request not in REQUESTS[service].split():
        raise RefusedError(f"REQUEST of {service.upper()} is one of: {REQUESTS[service]}.")
    for name, value in given.items():
        if name not in PARAMETERS[service].split():
            raise RefusedError(f"{_shown(name)} is no parameter that is served here.")
        _check_value(name, value)


def is_of_features(path: str, parameters: Mapping[str, str]) -> bool:
    """Tell whether OGC API Features is asked, whose errors are JSON."""
    has_service = any(name.lower() == "service" for name in parameters)
    return not has_service and (path == FEATURES or path.startswith((FEATURES + "/", FEATURES + ".")))


def _check_features(path: str, given: Mapping[str, str]) -> None:
    if not is_of_features(path, given):
        raise RefusedError(f"Give SERVICE and REQUEST, or a path below {FEATURES}.")
    if "map" in given:
        raise RefusedError("MAP is no parameter that is served here.")


def _check_value(name: str, value: str) -> None:
    if len(value) > MOST_LETTERS:
        raise RefusedError(f"{name.upper()} has more than {MOST_LETTERS} letters.")
    if name == "filter" and value and not (CONDITIONS.fullmatch(value) or _is_xml(value)):
        raise RefusedError("FILTER may compare fields with values, and has no functions and no entities.")
    if name in MOST and value and not (NUMBER.fullmatch(value) and float(value) <= MOST[name]):
        raise RefusedError(f"{name.upper()} is a number of at most {MOST[name]}.")
    if name in REPEATED and len(names := value.lower().split(",")) != len(set(names)):
        raise RefusedError(f"{name.upper()} names a layer twice.")
    if name == "format" and "dxf" in value.lower():
        raise RefusedError("FORMAT is none that is served here; features are served by WFS.")
    if name in NAMES and not NAMES[name].fullmatch(value):
        raise RefusedError(f"{name.upper()} may hold names.")


def _is_xml(value: str) -> bool:
    return bool(XML.fullmatch(value)) and not re.search("function|<!|&", value, re.IGNORECASE)


def _shown(name: str) -> str:
    return re.sub(r"\W", "?", name.upper())[:40]


def place_layers() -> None:
    """Give the fleet's layers the extent of the site.

    QGIS Server takes that of the rows which are there when it begins. Of none it is a point at the equator,
    and clients of WMS draw nothing beyond it.
    """
    project = QgsConfigCache.instance().project(os.environ.get("QGIS_PROJECT_FILE", ""))
    for layer in project.mapLayers().values() if project is not None else ():
        if extent := layer.customProperty("fleet/extent"):
            layer.extent()  # else the first who asks for it has it counted anew
            layer.setExtent(QgsRectangle.fromWkt(extent))


def serverClassFactory(interface: QgsServerInterface) -> RequestGuard:  # noqa: N802 # QGIS
    """Return the guard; QGIS Server asks for it when it starts."""
    guard = RequestGuard(interface)
    interface.registerFilter(guard, 0)
    return guard
