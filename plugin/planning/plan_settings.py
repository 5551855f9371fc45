"""Settings of a cone plan, kept with the project: cone and store layers, robots that take part."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, fields, replace
from itertools import takewhile
from typing import Any

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeatureRequest,
    QgsProject,
    QgsVectorLayer,
    QgsVectorLayerFeatureSource,
    QgsWkbTypes,
)

from ...robot_bridge.core.assignment.job import FINISHES, PLACE, STAY, ConeTarget, PlanRobot, Store
from ...robot_bridge.core.assignment.progress import ConeFacts
from ...robot_bridge.core.assignment.schedules import BALANCED, OBJECTIVES
from ...robot_bridge.core.geometry import theta_of
from ...robot_bridge.core.json_decoder import decode_json
from ...robot_bridge.core.messages.safety import RobotState
from ...robot_bridge.core.sites.frame import SiteFrame
from ..gateway_client.robot_states import STATES, RobotArrays
from ..layers.crs import stated_crs
from ..layers.reading import OneAtATime
from ..layers.site_transform import SiteGeoreference
from ..processing.common.cone_layers import PointRow, point_rows
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.scheduling import Steps

# --- The operator's settings of a plan, kept with the project ---

SCOPE, KEY = "fleet_supervisor", "plans/settings"


@dataclass(frozen=True)
class PlanRobotSettings:
    """The abilities of one robot: cones carried, cones aboard now, m/s, range in metres (0: unlimited)."""

    used: bool = True
    capacity: int = 8
    aboard: int = 0
    speed: float = 1.0
    range_m: float = 0.0

    def robot(self, name: str, x: float, y: float) -> PlanRobot:
        """Return the robot ``name`` at (x, y), as used by an assignment."""
        return PlanRobot(
            name, x, y, self.capacity, self.speed, self.range_m or math.inf, min(self.aboard, self.capacity)
        )


@dataclass(frozen=True)
class PlanSettings:
    """The panel's settings. Layers are named by their ids; an empty id means none.

    ``direct_m`` is the distance up to which robots drive straight and not along the roads; ``clearance_m``
    their distance from cones; ``apart_m`` from one another. With ``by_itself`` a new plan is sent without
    confirmation when a robot is lost.
    """

    cones: str = ""
    selected_only: bool = False
    stores: str = ""
    objective: str = BALANCED
    finish: str = STAY
    seconds: float = 10.0
    service_s: float = 5.0
    store_s: float = 30.0
    on_roads: bool = True
    direct_m: float = 25.0
    clearance_m: float = 0.8
    apart_m: float = 2.0
    by_itself: bool = False
    robots: dict[str, PlanRobotSettings] = field(default_factory=dict)

    @property
    def off_standing_m(self) -> float:
        """The distance from a standing robot: half of that between two driving ones, as only one errs."""
        return max(self.clearance_m, self.apart_m / 2)

    def of_robot(self, name: str) -> PlanRobotSettings:
        """Return the settings of a robot, the defaults where it has none."""
        return self.robots.get(name, PlanRobotSettings())

    def with_robot(self, name: str, settings: PlanRobotSettings) -> PlanSettings:
        """Return these settings with those of one robot changed."""
        return replace(self, robots={**self.robots, name: settings})


def read_settings(project: QgsProject) -> PlanSettings:
    """Return the settings kept in ``project``; missing or invalid ones have their defaults."""
    text, found = project.readEntry(SCOPE, KEY, "")
    if not found or not text:
        return PlanSettings()
    try:
        given = decode_json(text)
        robots = {name: _made(PlanRobotSettings, one) for name, one in given.pop("robots", {}).items()}
        made = _made(PlanSettings, given)
    except (ValueError, TypeError, AttributeError):
        return PlanSettings()
    if made.objective not in OBJECTIVES or made.finish not in FINISHES:
        made = replace(made, objective=BALANCED, finish=STAY)
    # Sending without confirmation must be switched on again in each session.
    return replace(made, robots=robots, by_itself=False)


def keep_settings(project: QgsProject, settings: PlanSettings) -> None:
    """Store the settings in ``project``."""
    project.writeEntry(SCOPE, KEY, json.dumps(asdict(settings)))


def _made(kind: type, given: dict[str, Any]):
    usual = kind()
    known = {one.name: getattr(usual, one.name) for one in fields(kind)}
    values = {}
    for name, value in given.items():
        fitting = (int, float) if isinstance(known.get(name), float) else type(known.get(name))
        if name in known and isinstance(value, fitting):
            values[name] = value
    return kind(**values)


# --- The robots available for a plan ---

_IS_HERE = np.array([state in (RobotState.FRESH, RobotState.STALE) for state in STATES])
Which = npt.NDArray[np.bool_]


def have_position(robots: RobotArrays) -> Which:
    """Return which robots have ever reported their position."""
    return np.isfinite(robots.xy).all(axis=1)


def available_robots(robots: RobotArrays) -> Which:
    """Return which robots are available for plans: they have reported a position, and are not away."""
    return have_position(robots) & _IS_HERE[robots.state]


def participating_robots(robots: RobotArrays, settings: PlanSettings) -> Which:
    """Return which robots are available for plans and selected."""
    used = np.array([settings.of_robot(name).used for name in robots.names], dtype=bool)
    return available_robots(robots) & used


# --- Cones and stores, read from the project's point layers into the site frame ---

_NAMES = ("id", "name")


class ConeLayerError(FleetError):
    """There is no layer of cones or stores to plan for, or it is empty."""


def point_layers(project: QgsProject) -> list[QgsVectorLayer]:
    """Return the layers that may contain cones or stores, by name."""
    points = QgsWkbTypes.GeometryType.PointGeometry
    found = [
        layer
        for layer in project.mapLayers().values()
        if isinstance(layer, QgsVectorLayer) and layer.isValid() and layer.isSpatial()
        and layer.geometryType() == points and not layer.customProperty("fleet/live")
    ]  # fmt: skip
    return sorted(found, key=lambda layer: (layer.name().casefold(), layer.id()))


def read_cones(
    project: QgsProject, settings: PlanSettings, frame: SiteFrame, readings: OneAtATime
) -> Steps[tuple[tuple[ConeTarget, ...], dict[str, ConeFacts]]]:
    """Return the cones to place, in the site frame, and the attributes of each, by the target's id.

    Fields: ``id``, ``heading`` (degrees clockwise from north), ``layout``, ``stage``, ``demand`` and
    ``service_s``.

    :raises ConeLayerError: when the layer does not exist, or is empty; LayerReadingError naming the layer,
    the feature and the invalid field, or a layer that does not answer.
    """
    layer = project.mapLayer(settings.cones)
    if layer is None:
        raise ConeLayerError(tr("No layer of cones is chosen. Choose one, or place a cone layout first."))
    targets, facts = [], {}
    # It may be gone when it has been read.
    name = layer.name()
    for row in (yield from _rows(layer, project, frame, readings, selected=settings.selected_only)):
        theta = frame.theta_to_site(theta_of(row.number("heading", 90.0)))
        stage, demand = row.whole("stage", 0), row.whole("demand", 1)
        service_s = row.number("service_s", settings.service_s)
        targets.append(ConeTarget(row.name, row.x, row.y, theta, stage, PLACE, demand, service_s))
        facts[row.name] = ConeFacts(row.name, str(row.values.get("layout") or name))
    if not targets:
        which = tr("no selected features") if settings.selected_only else tr("no features")
        raise ConeLayerError(
            tr(
                "The layer {layer} has {which}: there is nothing to be placed.",
                layer=name,
                which=which,
            )
        )
    return tuple(targets), facts


def read_stores(
    project: QgsProject, settings: PlanSettings, frame: SiteFrame, readings: OneAtATime
) -> Steps[tuple[Store, ...]]:
    """Return the stores in the site frame, empty where no layer is chosen; raises as :func:`read_cones`."""
    if not settings.stores:
        return ()
    layer = project.mapLayer(settings.stores)
    if layer is None:
        raise ConeLayerError(
            tr("The layer of stores is not in the project any more. Choose another, or none.")
        )
    rows = yield from _rows(layer, project, frame, readings, selected=False)
    return tuple(Store(row.name, row.x, row.y, row.number("service_s", settings.store_s)) for row in rows)


def _rows(
    layer: QgsVectorLayer, project: QgsProject, frame: SiteFrame, readings: OneAtATime, *, selected: bool
) -> Steps[list[PointRow]]:
    reader = _RowReader(layer, project, frame, selected)
    return (yield from readings.read(layer.name(), reader))


class _RowReader:
    """Reads the points of a layer, in any thread."""

    def __init__(self, layer: QgsVectorLayer, project: QgsProject, frame: SiteFrame, selected: bool):
        self._name, self._crs = layer.name(), layer.crs()
        self._features = QgsVectorLayerFeatureSource(layer)
        self._request = QgsFeatureRequest()
        if selected:
            self._request.setFilterFids(layer.selectedFeatureIds())
        self._frame, self._transforms = frame, project.transformContext()

    def read(self, go_on: Callable[[], bool]) -> list[PointRow]:
        crs = stated_crs(QgsCoordinateReferenceSystem(self._frame.crs))
        site = SiteGeoreference(crs, self._frame, self._transforms)
        placing = site.of_layer(self._name, self._crs)
        features = takewhile(lambda _: go_on(), self._features.getFeatures(self._request))
        return list(point_rows(self._name, features, placing, _NAMES))
