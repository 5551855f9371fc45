"""Parameters shared by algorithms: points and extents, CRS and frame of the site, window, input layers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsMapLayer,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterCrs,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProject,
    QgsVectorLayer,
)

from ....robot_bridge.core.robotmap.model import Window
from ....robot_bridge.core.sites.frame import SiteFrame
from ...layers.crs import crs_name, frame_in_project, site_crs_for, stated_crs
from ...layers.layer_expressions import FeatureFilter
from ...layers.layer_source import Setups
from ...layers.roles import SUFFIXES, find_profile, read_profile, setup_of
from ...layers.site_transform import check_transform
from ...ui.errors import LayerTypeError
from ...ui.language import tr
from .algorithm import ParameterError, Parameters, advanced

# --- Points and extents of parameters, transformed to one CRS ---


def point_in(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    name: str,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> tuple[float, float]:
    """Return the point of the parameter ``name`` in ``crs``; one without a CRS is in it already.

    :raises ParameterError: when it has no place there: QGIS itself would take degrees for metres.
    """
    point = algorithm.parameterAsPoint(parameters, name, context)
    # Without a project in the context, as a point without a CRS would be in the project's.
    own = algorithm.parameterAsPointCrs(parameters, name, QgsProcessingContext())
    if own.isValid() and own != crs:
        way = _way(name, parameters.get(name), own, crs, context)
        try:
            point = way.transform(point)
        except QgsCsException as error:
            raise _no_place(name, parameters.get(name), crs) from error
    if not (math.isfinite(point.x()) and math.isfinite(point.y())):
        raise _no_place(name, parameters.get(name), crs)
    return point.x(), point.y()


def extent_in(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    name: str,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> np.ndarray:
    """Return the outline, (n, 2) in ``crs``, of the extent of the parameter ``name``.

    :raises ParameterError: when it is invalid, or has no place there.
    """
    own = algorithm.parameterAsExtentCrs(parameters, name, QgsProcessingContext())
    if own.isValid():
        _way(name, parameters.get(name), own, crs, context)
    outline = algorithm.parameterAsExtentGeometry(parameters, name, context, crs)
    corners = np.array([(vertex.x(), vertex.y()) for vertex in outline.vertices()])
    if not len(corners):
        raise ParameterError(
            tr(
                "{name} {extent} is no extent: write 'xmin,xmax,ymin,ymax'.",
                name=name,
                extent=parameters.get(name),
            )
        )
    if not np.isfinite(corners).all():
        raise _no_place(name, parameters.get(name), crs)
    return corners


def _way(
    name: str,
    value: Any,
    own: QgsCoordinateReferenceSystem,
    crs: QgsCoordinateReferenceSystem,
    context: QgsProcessingContext,
) -> QgsCoordinateTransform:
    way = QgsCoordinateTransform(own, crs, context.transformContext())
    try:
        check_transform(way)
    except QgsCsException as error:
        raise ParameterError(
            tr(
                "{name} {value} is in the CRS {own}, which has no known relation to the CRS {crs}: give it "
                "in that one.",
                name=name,
                value=value,
                own=crs_name(own),
                crs=crs_name(crs),
            )
        ) from error
    return way


def _no_place(name: str, value: Any, crs: QgsCoordinateReferenceSystem) -> ParameterError:
    return ParameterError(
        tr(
            "{name} {value} has no place in the CRS {crs}: give finite numbers, x or longitude first, and "
            "the CRS that they are in.",
            name=name,
            value=value,
            crs=crs_name(crs),
        )
    )


# --- The georeference of the site: its CRS, from parameters, layers and the project, and its frame ---

SITE_CRS, ORIGIN, ROTATION = "SITE_CRS", "ORIGIN", "ROTATION"


def site_crs_parameter(title: str) -> QgsProcessingParameterDefinition:
    """Return the parameter of the CRS; ``title`` describes its default."""
    return QgsProcessingParameterCrs(SITE_CRS, title, optional=True)


def frame_in_crs_parameters(origin: str = "", rotation: str = "") -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the frame in that CRS; ``origin`` and ``rotation`` are titles of their own."""
    return [
        QgsProcessingParameterPoint(
            ORIGIN,
            origin or tr("Origin of the site frame (default: as the project has it, else 0,0)"),
            optional=True,
        ),
        QgsProcessingParameterNumber(
            ROTATION,
            rotation or tr("Rotation of the site frame, counter-clockwise from the CRS's x axis [degrees]"),
            QgsProcessingParameterNumber.Type.Double,
            optional=True,
        ),
    ]


def given_crs(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> QgsCoordinateReferenceSystem:
    """Return SITE_CRS, invalid where it is not given.

    :raises ParameterError: when QGIS does not know it.
    """
    crs = algorithm.parameterAsCrs(parameters, SITE_CRS, context)
    if parameters.get(SITE_CRS) and not crs.isValid():
        raise ParameterError(
            tr(
                "SITE_CRS {crs} is no CRS that QGIS knows: write a code such as EPSG:32633.",
                crs=parameters[SITE_CRS],
            )
        )
    return crs


def chosen_crs(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    layers: Sequence[QgsCoordinateReferenceSystem],
    *,
    layer_first: bool = False,
) -> QgsCoordinateReferenceSystem:
    """Return the CRS of the site: SITE_CRS, else the project's or the layers' own.

    With ``layer_first`` that of the first layer wins over the project's, unless it is in degrees. The
    result is invalid when no CRS is known at all.

    :raises FleetError: when SITE_CRS is no CRS, or the chosen one cannot carry a site.
    """
    chosen, own = given_crs(algorithm, parameters, context), [stated_crs(crs) for crs in layers]
    if layer_first and not chosen.isValid() and own and own[0].isValid() and not own[0].isGeographic():
        chosen = own[0]
    project = context.project()
    return site_crs_for(chosen, QgsCoordinateReferenceSystem() if project is None else project.crs(), own)


# --- The window of a robot map, and its frame, from an algorithm's parameters ---

CENTER, WIDTH, HEIGHT, EXTENT = "CENTER", "WIDTH", "HEIGHT", "EXTENT"
LOCAL = "LOCAL"
PAPERS_SIDE_M = 100.0

_REAL = QgsProcessingParameterNumber.Type.Double


def window_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters of the map's window and frame."""
    return [
        QgsProcessingParameterPoint(CENTER, tr("Centre of the window (or choose an extent)"), optional=True),
        QgsProcessingParameterNumber(WIDTH, tr("Width of the window, along x [m]"), _REAL, PAPERS_SIDE_M),
        QgsProcessingParameterNumber(HEIGHT, tr("Height of the window, along y [m]"), _REAL, PAPERS_SIDE_M),
        QgsProcessingParameterExtent(
            EXTENT, tr("Extent (instead of centre, width and height)"), optional=True
        ),
        *frame_parameters(),
    ]


def frame_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the advanced parameters of the site's frame."""
    title = tr("Site CRS, in metres (default: the project's, else the layers')")
    local = QgsProcessingParameterBoolean(
        LOCAL, tr("Layers without a CRS are in metres of the site"), defaultValue=False
    )
    return [advanced(one) for one in (site_crs_parameter(title), *frame_in_crs_parameters(), local)]


def window_problem(parameters: Parameters) -> str:
    """Return the error in the choice of window, or an empty text."""
    has_center, has_extent = _given(parameters, CENTER), _given(parameters, EXTENT)
    if has_center and has_extent:
        return tr("Both CENTER and EXTENT are given: give one of them, the window cannot be both.")
    if not has_center and not has_extent:
        return tr(
            "Neither CENTER nor EXTENT is given: give the centre of the window with WIDTH and HEIGHT in "
            "metres, or an extent."
        )
    for side in (WIDTH, HEIGHT):
        if not _is_number(parameters.get(side, PAPERS_SIDE_M)):
            return tr(
                "{side} is {length}: give a finite number of metres.", side=side, length=parameters[side]
            )
    return ""


def site_frame(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
) -> SiteFrame:
    """Return the project's site frame, else ``crs`` itself, with ORIGIN and ROTATION where they are given."""
    name = crs.authid() or (crs_name(crs) if crs.isValid() else "")
    known = frame_in_project(context.project(), crs) if context.project() is not None else None
    frame = known or SiteFrame(name, (0.0, 0.0))
    if _given(parameters, ORIGIN):
        frame = replace(frame, origin=point_in(algorithm, parameters, ORIGIN, context, crs))
    if _given(parameters, ROTATION):
        degrees = algorithm.parameterAsDouble(parameters, ROTATION, context)
        if not math.isfinite(degrees):
            raise ParameterError(tr("ROTATION {degrees} is not finite: give a number.", degrees=degrees))
        frame = replace(frame, rotation=math.radians(degrees))
    return frame


def map_window(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    crs: QgsCoordinateReferenceSystem,
    frame: SiteFrame,
) -> Window:
    """Return the window in the site frame.

    Positions without their own CRS are in ``crs``. An extent whose sides are not parallel to the site's
    axes becomes the smallest window that contains it.

    :raises ParameterError: when the window has no place in ``crs``; WindowError when it encloses nothing.
    """
    if _given(parameters, EXTENT):
        corners = frame.to_site(extent_in(algorithm, parameters, EXTENT, context, crs))
        return Window.from_bounds(*_rounded(corners.min(axis=0)), *_rounded(corners.max(axis=0)))
    ((x, y),) = frame.to_site([point_in(algorithm, parameters, CENTER, context, crs)])
    return Window(
        float(x),
        float(y),
        algorithm.parameterAsDouble(parameters, WIDTH, context),
        algorithm.parameterAsDouble(parameters, HEIGHT, context),
    )


def _given(parameters: Parameters, name: str) -> bool:
    value = parameters.get(name)
    return value is not None and value != ""


def _is_number(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        # None is the default, and QGIS has more kinds of values than numbers, such as properties.
        return not isinstance(value, str)


def _rounded(corner: np.ndarray) -> list[float]:
    """Return the corner without the rounding errors of a rotation forth and back."""
    return [float(value) for value in np.round(corner, 6)]


# --- Layers of a parameter, before they are read ---


def layer_in(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, name: str, context: QgsProcessingContext
) -> QgsVectorLayer | None:
    """Return the layer from which the parameter ``name`` takes its features, None where there is none."""
    value = parameters.get(name)
    # With "selected features only" the value is no layer to parameterAsVectorLayer.
    chosen = value.source.staticValue() if isinstance(value, QgsProcessingFeatureSourceDefinition) else value
    return algorithm.parameterAsVectorLayer({**parameters, name: chosen}, name, context)


# --- The parameter PROFILE: roles of layers, from a file instead of from the project ---

PROFILE = "PROFILE"


def profile_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter; its value is a path or the name of a profile that comes with the plugin."""
    kinds = " ".join(f"*{suffix}" for suffix in SUFFIXES)
    return QgsProcessingParameterFile(
        PROFILE,
        tr("Map profile: what the layers are, by their names (default: as each layer keeps it)"),
        optional=True,
        # "All files" also lets the name of a shipped profile pass QGIS's check of the value.
        fileFilter=tr("Map profile ({kinds});;All files (*)", kinds=kinds),
    )


def setups_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> Setups:
    """Return the function that gives the role and the expressions of a layer.

    :raises ProfileError: when the profile cannot be read.
    """
    chosen = algorithm.parameterAsFile(parameters, PROFILE, context)
    return read_profile(find_profile(chosen)).setup_over if chosen else setup_of


def warn_of_profile(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    layers: Iterable[QgsMapLayer],
    feedback: QgsProcessingFeedback,
) -> None:
    """Report the names that the profile expects, if there is one and it matches none of ``layers``.

    :raises ProfileError: when the profile cannot be read.
    """
    chosen = algorithm.parameterAsFile(parameters, PROFILE, context)
    profile = read_profile(find_profile(chosen)) if chosen else None
    if profile is None or any(profile.setup_for(layer) is not None for layer in layers):
        return
    feedback.pushWarning(
        tr(
            "{name} knows none of these layers. It looks for layers that are named, in their source or "
            "in the project: {sought}.",
            name=profile.name,
            sought=profile.sought(),
        )
    )


def layers_of_project(
    project: QgsProject | None, roles: Sequence[str], setups: Setups
) -> list[QgsVectorLayer]:
    """Return the layers of ``project`` that ``setups`` gives one of ``roles``, sorted by name and id.

    :raises LayerTypeError: naming the first that is no vector layer.
    """
    layers = project.mapLayers().values() if project is not None else ()
    found = [layer for layer in layers if setups(layer).role in roles]
    check_vectors(found)
    return sorted(found, key=lambda layer: (layer.name(), layer.id()))


def check_vectors(layers: Sequence[QgsMapLayer]) -> None:
    """Raise LayerTypeError for the first of ``layers`` that is no vector layer."""
    for layer in layers:
        if not isinstance(layer, QgsVectorLayer):
            raise LayerTypeError(
                tr("The layer {layer} is no vector layer: take its role away.", layer=layer.name())
            )


def filter_in(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, name: str, context: QgsProcessingContext
) -> FeatureFilter | None:
    """Return the filter of the layer from which the parameter ``name`` takes its features.

    None where there is no layer.

    :raises ExpressionError: when the layer's filter is not an expression.
    """
    layer = layer_in(algorithm, parameters, name, context)
    if layer is None:
        return None
    return FeatureFilter.of_layer(layer, algorithm.createExpressionContext(parameters, context))
