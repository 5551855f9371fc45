"""The expression functions, their registration in QGIS, and the snapshot of robots that they read."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionFunction,
    QgsExpressionNodeFunction,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QObject

from ..robot_bridge.core.clock import steady_time
from ..robot_bridge.core.messages.base import is_robot_name
from .gateway_client.fleet_state import FleetState
from .gateway_client.robot_states import STATES
from .layers.road_surfaces import SurfaceStore
from .layers.roles import ROAD_SURFACE
from .layers.site_transform import check_transform, frame_of
from .ui.errors import FleetError
from .ui.language import tr, tr_page
from .ui.scheduling import UpdateScheduler

if TYPE_CHECKING:  # qgis_process has no window, and needs nothing of what one is made of
    from .control.view_subscription import ViewSubscription

# --- Snapshot of robots that expressions read, and its updates ---

Numbers = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RobotSnapshot:
    """Robots known to the desk at ``taken`` (seconds, monotonic clock); immutable.

    ``rows`` maps a name to a row of the arrays: ``states`` (n) names of states, ``xy`` (n, 2) places in
    ``crs``, ``age`` (n,) seconds since the last message and ``battery`` (n,) fraction of a full one, NaN
    where not known. Without ``is_whole`` there are other robots than these.
    """

    crs: QgsCoordinateReferenceSystem
    rows: dict[str, int]
    states: list[str]
    xy: Numbers
    age: Numbers
    battery: Numbers
    taken: float
    is_whole: bool = True

    def state(self, robot: str) -> str | None:
        """Return a robot's state, None for a robot that is not known."""
        row = self.rows.get(robot)
        return None if row is None else self.states[row]

    def charge(self, robot: str) -> float | None:
        """Return the charge of a robot's battery, 0 to 1; None where that is not known."""
        return self._number(self.battery, robot)

    def silence(self, robot: str, now: float | None = None) -> float | None:
        """Return the seconds since a robot's last message."""
        age = self._number(self.age, robot)
        now = steady_time() if now is None else now
        return None if age is None else age + max(0.0, now - self.taken)

    def place(self, robot: str) -> QgsPointXY | None:
        """Return a robot's position, in :attr:`crs`; None where that is not known."""
        row = self.rows.get(robot)
        if row is None or not np.isfinite(self.xy[row]).all():
            return None
        return QgsPointXY(*self.xy[row].tolist())

    def _number(self, column: Numbers, robot: str) -> float | None:
        row = self.rows.get(robot)
        return None if row is None or not np.isfinite(column[row]) else float(column[row])


MOST_NAMED = 200
"""Robots received wherever they are because expressions name them: those named last."""
NAMED_FOR_S = 60.0
"""Seconds for which a robot is received after an expression named it."""


class SnapshotHolder:
    """Holds the newest :class:`RobotSnapshot`, None while no gateway has reported any robot.

    Expressions are evaluated in QGIS's threads: :meth:`read` may be called in any.
    """

    def __init__(self) -> None:
        self.robots: RobotSnapshot | None = None
        self._watched: frozenset[str] = frozenset()
        self._named: dict[str, None] = {}
        self._lock = threading.Lock()

    def replace(self, robots: RobotSnapshot | None) -> None:
        """Hold another snapshot from now on."""
        self.robots = robots

    @property
    def watched(self) -> frozenset[str]:
        """Robots received wherever they are, since expressions name them."""
        return self._watched

    def watch(self, robots: Iterable[str]) -> None:
        """Keep these robots recorded as long as expressions name them, though they are known."""
        self._watched = frozenset(robots)

    def read(self, robot: str) -> RobotSnapshot | None:
        """Return the snapshot for an expression that names ``robot``, which is recorded if not in view."""
        robots = self.robots
        if robots is None or robots.is_whole:
            return robots
        # A robot in view needs no place among those received wherever they are.
        if robot in self._watched or (robot not in robots.rows and is_robot_name(robot)):
            self._record(robot)
        return robots

    def _record(self, robot: str) -> None:
        with self._lock:
            self._named.pop(robot, None)
            self._named[robot] = None
            if len(self._named) > MOST_NAMED:
                del self._named[next(iter(self._named))]

    def collect_named(self) -> list[str]:
        """Return the robots recorded since the last call, the one that was named last at the end."""
        if not self._named:
            return []
        with self._lock:
            named, self._named = self._named, {}
        return list(named)


_NAMES = np.array([state.value for state in STATES], dtype=object)


class ExpressionUpdater(QObject):
    """Makes snapshots of the desk's state for expressions, and has the desk receive the robots they name.

    :meth:`remove` leaves them without one.
    """

    def __init__(
        self, state: FleetState, view: ViewSubscription, scheduler: UpdateScheduler, fleet: SnapshotHolder
    ):
        super().__init__(state)
        self._state, self._view, self._fleet = state, view, fleet
        self._named: dict[str, float] = {}
        """When expressions last named robots, the last one at the end."""
        self._turn = scheduler.turn()
        self._rows: dict[str, int] = {}
        self._arrangement = -1
        state.updated.connect(self._pulled)
        state.site_changed.connect(self.feed)
        state.robots_removed.connect(self.feed)

    def remove(self) -> None:
        """Stop making snapshots."""
        self._fleet.replace(None)

    def feed(self) -> None:
        """Make the current snapshot."""
        state, now = self._state, self._state.clock.steady()
        if state.site is None:
            self._fleet.replace(None)
            return
        robots = state.robots.arrays(now)
        if self._arrangement != state.robots.arrangement or len(self._rows) != len(robots.names):
            self._arrangement = state.robots.arrangement
            self._rows = {name: row for row, name in enumerate(robots.names)}
        frame = frame_of(state.site)
        snapshot = RobotSnapshot(
            crs=QgsCoordinateReferenceSystem(state.site.crs),
            rows=self._rows,
            states=_NAMES[robots.state].tolist(),
            xy=frame.to_crs(robots.xy),
            age=robots.age,
            battery=state.robots.column("battery"),
            taken=now,
            is_whole=state.robots.fleet is None,
        )
        self._fleet.replace(snapshot)

    def _pulled(self) -> None:
        self._watch_named()
        if self._turn.is_due():
            self.feed()

    def _watch_named(self) -> None:
        """Request the robots that expressions have named within the last minute, and no others."""
        now = self._state.clock.steady()
        for name in self._fleet.collect_named():
            self._named.pop(name, None)
            self._named[name] = now
        if self._state.robots.fleet is None:
            self._named.clear()
        while self._named:
            oldest = next(iter(self._named))
            if len(self._named) <= MOST_NAMED and now - self._named[oldest] < NAMED_FOR_S:
                break
            del self._named[oldest]
        if self._named.keys() != self._fleet.watched:
            self._fleet.watch(self._named)
            # In a stable order: in another one they would be requested again.
            self._view.watch_named(sorted(self._named))


# --- The functions, and their registration in QGIS ---


def crs_of_place(given: Any, of_layer: Any) -> QgsCoordinateReferenceSystem:
    """Return the CRS of a place: as given, else that of the layer evaluated, else that of the project.

    :raises FleetError: when QGIS does not know the one that is given.
    """
    if given is not None:
        crs = QgsCoordinateReferenceSystem(str(given))
        if not crs.isValid():
            raise FleetError(
                tr("crs {given!r} is no CRS that QGIS knows; write a code such as 'EPSG:32633'", given=given)
            )
        return crs
    crs = QgsCoordinateReferenceSystem(str(of_layer or ""))
    return crs if crs.isValid() else QgsProject.instance().crs()


GROUP = tr("Fleet")
"""The group in which QGIS lists the functions."""
_OUT_OF_VIEW = tr_page("""
<p>Of more than 5 000 robots QGIS is told of those on the map. Another one is asked for when an expression
names it, and for a minute from then on, up to 200 of them: about a second later it has its value, NULL
until then.</p>
""")
DISTANCE_TO_ROBOT = "distance_to_robot"
_DISTANCE_HELP = tr_page("""
<h3>function distance_to_robot</h3>
<p>Returns how far a robot is from a feature or a geometry, in metres of the site.</p>
<h4>Syntax</h4>
<p><code>distance_to_robot(robot, [geometry], [crs])</code></p>
<h4>Arguments</h4>
<table>
<tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr>
<tr><td><i>geometry</i></td><td>optional; without it, that of the feature that is looked at</td></tr>
<tr><td><i>crs</i></td><td>optional, the CRS of the geometry, such as 'EPSG:4326'; without it, that of the
layer whose feature is looked at, else that of the project</td></tr>
</table>
<h4>Examples</h4>
<ul>
<li><code>distance_to_robot('r1')</code> &rarr; 12.3</li>
<li><code>distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')</code> &rarr; 104.6</li>
<li><code>distance_to_robot('r1') &lt; 5</code> &rarr; true of features near the robot</li>
</ul>
<h4>Notes</h4>
<p>The distance is measured in the plane of the site's CRS; in a polygon it is 0. NULL stands for a robot
whose place is not known, and while this QGIS is connected to no gateway. Places are at most half a second
old; a layer shows them when it is drawn.</p>
""")


class _RobotFunction(QgsExpressionFunction):
    """A function of robots, independent of the feature."""

    def isStatic(
        self, _node: QgsExpressionNodeFunction, _parent: QgsExpression, _context: QgsExpressionContext
    ):
        # QGIS evaluates constant expressions once; robots change.
        return False

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return False

    def referencedColumns(self, _node: QgsExpressionNodeFunction):
        return set()


class DistanceToRobot(_RobotFunction):
    """Measures the distance from a robot's present position."""

    def __init__(self, fleet: SnapshotHolder):
        parameter = QgsExpressionFunction.Parameter
        parameters = [parameter("robot"), parameter("geometry", True), parameter("crs", True)]
        # Handles NULL itself: an omitted argument is NULL, too.
        super().__init__(
            DISTANCE_TO_ROBOT,
            parameters,
            GROUP,
            _DISTANCE_HELP + _OUT_OF_VIEW,
            lazyEval=False,
            handlesNull=True,
        )
        self._fleet = fleet

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return True

    def func(
        self,
        values: Sequence[Any],
        context: QgsExpressionContext,
        parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        robot, geometry, crs = (None if _is_null(value) else value for value in values)
        robots = None if robot is None else self._fleet.read(str(robot))
        place = None if robots is None else robots.place(str(robot))
        if robots is None or place is None:
            return None
        if geometry is None:
            geometry = context.feature().geometry() if context is not None else None
        if not isinstance(geometry, QgsGeometry):
            parent.setEvalErrorString(
                tr(
                    "{function}: {geometry!r} is no geometry; give one, or a feature that has one",
                    function=DISTANCE_TO_ROBOT,
                    geometry=geometry,
                )
            )
            return None
        if geometry.isNull():
            return None
        try:
            return _placed(geometry, crs, robots.crs, context).distance(QgsGeometry.fromPointXY(place))
        except FleetError as error:
            parent.setEvalErrorString(f"{DISTANCE_TO_ROBOT}: {error}")
        except QgsCsException:
            parent.setEvalErrorString(
                tr(
                    "{function}: the geometry has no place in {crs}",
                    function=DISTANCE_TO_ROBOT,
                    crs=robots.crs.authid(),
                )
            )
        return None


def _placed(
    geometry: QgsGeometry,
    crs: Any,
    site_crs: QgsCoordinateReferenceSystem,
    context: QgsExpressionContext | None,
) -> QgsGeometry:
    """Return ``geometry`` in ``site_crs``; the transform is looked up once per context."""
    of_layer = context.variable("layer_crs") if context is not None else None
    key = f"fleet {DISTANCE_TO_ROBOT} {crs} {of_layer} {site_crs.authid()}"
    if context is not None and context.hasCachedValue(key):
        way = context.cachedValue(key)
    else:
        way = QgsCoordinateTransform(crs_of_place(crs, of_layer), site_crs, QgsProject.instance())
        if context is not None:
            context.setCachedValue(key, way)
    check_transform(way)
    placed = QgsGeometry(geometry)
    if way.isValid():
        placed.transform(way)
    return placed


def _is_null(value: Any) -> bool:
    return value is None or (not isinstance(value, (QgsGeometry, QgsFeature)) and value == NULL)


ROAD_SURFACE_FUNCTION = "road_surface"
_ROAD_SURFACE_HELP = tr_page("""
<h3>function road_surface</h3>
<p>Returns the class of the road surface at a place, such as 'asphalt', or NULL where there is none.</p>
<h4>Syntax</h4>
<p><code>road_surface(x, y, [layer], [crs])</code></p>
<h4>Arguments</h4>
<table>
<tr><td><i>x, y</i></td><td>the place; x is the easting or the longitude, whatever the CRS</td></tr>
<tr><td><i>layer</i></td><td>optional, the name or id of a layer of areas; without it, all layers of the
project with the role road surface</td></tr>
<tr><td><i>crs</i></td><td>optional, the CRS of the place, such as 'EPSG:4326'; without it, that of the layer
whose feature is looked at, else that of the project</td></tr>
</table>
<h4>Examples</h4>
<ul>
<li><code>road_surface($x, $y)</code> &rarr; 'asphalt'</li>
<li><code>road_surface(16.8438, 46.8804, crs:='EPSG:4326')</code> &rarr; 'slippery'</li>
<li><code>road_surface($x, $y, 'Road surfaces') IS NULL</code> &rarr; true off the road</li>
</ul>
<h4>Notes</h4>
<p>A place on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a
generated one, then the smaller before the larger.</p>
""")


class RoadSurface(QgsExpressionFunction):
    """Returns the road surface at a place from ``store``."""

    def __init__(self, store: SurfaceStore):
        parameter = QgsExpressionFunction.Parameter
        parameters = [parameter("x"), parameter("y"), parameter("layer", True), parameter("crs", True)]
        # Handles NULL itself: an omitted argument is NULL, too.
        super().__init__(
            ROAD_SURFACE_FUNCTION,
            parameters,
            GROUP,
            _ROAD_SURFACE_HELP,
            lazyEval=False,
            handlesNull=True,
        )
        self._store = store

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return False

    def referencedColumns(self, _node: QgsExpressionNodeFunction):
        return set()

    def func(
        self,
        values: Sequence[Any],
        context: QgsExpressionContext,
        parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        x, y, layer, crs = (None if value == NULL else value for value in values)
        if x is None or y is None:
            return None
        try:
            surfaces, way = self._kept(layer, crs, context)
            found = surfaces.at(float(x), float(y), way)
        except (TypeError, ValueError):
            parent.setEvalErrorString(
                tr(
                    "{function}: x is {x!r} and y is {y!r}; give two numbers",
                    function=ROAD_SURFACE_FUNCTION,
                    x=x,
                    y=y,
                )
            )
            return None
        except FleetError as error:
            parent.setEvalErrorString(f"{ROAD_SURFACE_FUNCTION}: {error}")
            return None
        return None if found is None else found.label

    def _kept(self, layer: Any, crs: Any, context: QgsExpressionContext | None) -> tuple[Any, Any]:
        """Return the surfaces and the transform to them, which are looked up once per context."""
        of_layer = context.variable("layer_crs") if context is not None else None
        key = f"fleet road_surface {_named(layer)} {crs} {of_layer}"
        if context is not None and context.hasCachedValue(key):
            return context.cachedValue(key)
        surfaces = self._store.read(self._layers(layer))
        found = surfaces, surfaces.way_from(crs_of_place(crs, of_layer))
        if context is not None:
            context.setCachedValue(key, found)
        return found

    def _layers(self, layer: Any) -> list[QgsVectorLayer]:
        if layer is None:
            found = self._store.layers()
            if not found:
                raise FleetError(
                    tr(
                        "no layer of the project has the role {role}; set it in Plugins > Fleet Supervisor > "
                        "Layer roles, or name a layer as the third argument",
                        role=ROAD_SURFACE,
                    )
                )
            return found
        if isinstance(layer, QgsVectorLayer):
            return [layer]
        project = QgsProject.instance()
        named = project.mapLayer(str(layer)) or next(iter(project.mapLayersByName(str(layer))), None)
        if not isinstance(named, QgsVectorLayer):
            raise FleetError(tr("no vector layer of the project has the name or id {layer!r}", layer=layer))
        return [named]


def _named(layer: Any) -> str:
    return layer.id() if isinstance(layer, QgsVectorLayer) else str(layer)


_STATE_HELP = tr_page("""
<h3>function robot_state</h3>
<p>Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or 'offline'.</p>
<h4>Syntax</h4>
<p><code>robot_state(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_state('r1')</code> &rarr; 'fresh'</li>
<li><code>robot_state("robot") IN ('stale', 'lost')</code> &rarr; true of robots that are silent</li>
</ul>
""")
_BATTERY_HELP = tr_page("""
<h3>function robot_battery</h3>
<p>Returns how full a robot's battery is, 0 to 1.</p>
<h4>Syntax</h4>
<p><code>robot_battery(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_battery('r1')</code> &rarr; 0.82</li>
<li><code>round(100 * robot_battery('r1')) || ' %'</code> &rarr; '82 %'</li>
</ul>
""")
_AGE_HELP = tr_page("""
<h3>function robot_age</h3>
<p>Returns the seconds since a robot's last message, by this computer's clock.</p>
<h4>Syntax</h4>
<p><code>robot_age(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_age('r1')</code> &rarr; 0.4</li>
<li><code>robot_age('r1') &gt; 10</code> &rarr; true once it has been silent for more than 10 seconds</li>
</ul>
""")
_NOTES = tr_page("""
<h4>Notes</h4>
<p>NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. What is
not known of a robot is NULL as well. Values are at most half a second old; a layer shows them when it is
drawn.</p>
""")


class RobotValue(_RobotFunction):
    """Returns one value of a robot by its name."""

    def __init__(
        self, name: str, help_text: str, fleet: SnapshotHolder, value: Callable[[RobotSnapshot, str], object]
    ):
        super().__init__(name, [QgsExpressionFunction.Parameter("robot")], GROUP, help_text)
        self._fleet, self._value = fleet, value

    def func(
        self,
        values: Sequence[Any],
        _context: QgsExpressionContext,
        _parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        if values[0] is None or values[0] == NULL:
            return None
        robots = self._fleet.read(str(values[0]))
        return None if robots is None else self._value(robots, str(values[0]))


def robot_values(fleet: SnapshotHolder) -> list[RobotValue]:
    """Return the functions; each must be kept alive as long as QGIS has it."""
    notes = _NOTES + _OUT_OF_VIEW
    return [
        RobotValue("robot_state", _STATE_HELP + notes, fleet, RobotSnapshot.state),
        RobotValue("robot_battery", _BATTERY_HELP + notes, fleet, RobotSnapshot.charge),
        RobotValue("robot_age", _AGE_HELP + notes, fleet, RobotSnapshot.silence),
    ]


class ExpressionFunctions:
    """The functions while the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(self, surfaces: SurfaceStore, fleet: SnapshotHolder):
        # QGIS does not keep Python's functions alive; those that it rejects, as when two copies of the plugin
        # are loaded, are not ours to remove.
        made = [RoadSurface(surfaces), DistanceToRobot(fleet), *robot_values(fleet)]
        self._functions = [one for one in made if QgsExpression.registerFunction(one)]

    def remove(self) -> None:
        """Remove every function from QGIS."""
        for function in self._functions:
            QgsExpression.unregisterFunction(function.name())
        self._functions = []
