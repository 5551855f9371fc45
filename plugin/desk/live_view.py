"""Keeps the canvas true to the desk: the overlay ten times a second, the vector layer once, the view on a
robot that is followed."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsPointXY, QgsRectangle
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, QTimer

from ...robot_bridge.messages import CommandReport, SetPath
from ..errors import PlacementError
from .desk import PULL_EVERY_MS, Desk
from .overlay import FleetOverlay
from .robot_layer import RobotLayer
from .scene import Scene, Target, placed

FRAME_MS = 15
LAYER_EVERY = 1000 // PULL_EVERY_MS
FEWER_FRAMES_FROM = 300
"""With that many robots a frame takes long enough that every second pull, then every third, has to do."""
FOLLOW_INSIDE = 0.5
"""The part of the view, about its middle, that a followed robot moves in before the view moves."""
ZOOM_METRES = 30.0


class LiveView(QObject):
    """Owns the overlay and the robot layer."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._pulls = 0
        self.following = False
        self.overlay = FleetOverlay(desk.canvas)
        self.layer = RobotLayer(desk.project, self)
        self._frame = QTimer(self)
        self._frame.setSingleShot(True)
        self._frame.setInterval(FRAME_MS)
        self._frame.timeout.connect(self.show_now)
        desk.pulled.connect(self._pulled)
        desk.site_changed.connect(self._site_changed)
        desk.selection_changed.connect(self._selection_changed)
        desk.drafts.changed.connect(self._frame.start)
        desk.drafts.pointed.connect(self._frame.start)
        desk.canvas.destinationCrsChanged.connect(self._frame.start)
        self.layer.robot_selected.connect(desk.select)

    def remove(self) -> None:
        """Take the overlay off the canvas and the layer out of the project."""
        self._frame.stop()
        self._desk.canvas.destinationCrsChanged.disconnect(self._frame.start)
        self.layer.remove()
        if not sip.isdeleted(self.overlay):
            self._desk.canvas.scene().removeItem(self.overlay)

    def show_now(self) -> None:
        """Paint what the desk knows at this moment."""
        if self._desk.site is None:
            self.overlay.show_scene(None)
            return
        try:
            self.overlay.show_scene(placed(self._scene(), self._desk.placement()))
        except PlacementError as error:
            self.overlay.show_scene(None)
            self._desk.complained.emit(str(error))

    def zoom_to(self, robot: str) -> None:
        """Show ``robot`` and its surroundings."""
        view = self._desk.picture.view(robot, self._desk.clock())
        if view is None or not view.has_pose:
            self._desk.complained.emit(f"{robot} has not said yet where it is, so the map cannot go there.")
            return
        x, y, d = view.report.x, view.report.y, ZOOM_METRES
        corners = np.array([(x - d, y - d), (x + d, y - d), (x + d, y + d), (x - d, y + d)])
        extent = QgsRectangle()
        extent.setMinimal()
        for corner in self._desk.placement().to_map(corners):
            extent.combineExtentWith(*corner)
        self._desk.canvas.setExtent(extent)
        self._desk.canvas.refresh()

    def follow(self, on: bool) -> None:
        """Keep the selected robot in view, or stop doing so."""
        self.following = on
        if on and self._desk.selected is None:
            self._desk.complained.emit(
                "No robot is selected to be followed. Select one in the table or on the map."
            )

    def _pulled(self) -> None:
        self._pulls += 1
        if self._pulls % (1 + len(self._desk.picture) // FEWER_FRAMES_FROM) == 0:
            self._frame.start()
        newcomers = len(self._desk.picture) != len(self.layer)
        if self._pulls % LAYER_EVERY == 0 or newcomers:
            self._write_layer()
        if self._pulls % LAYER_EVERY == 0 and self.following:
            self._go_after()

    def _site_changed(self) -> None:
        self.layer.clear()
        self.layer.show_site(self._desk.site)
        self._frame.start()

    def _selection_changed(self) -> None:
        self.layer.mark(self._desk.selected)
        self._frame.start()

    def _write_layer(self) -> None:
        if self._desk.site is not None and self.layer.layer is None:
            # The project that held it was closed; the robots are still there.
            self.layer.show_site(self._desk.site)
        self.layer.update_robots(self._desk.picture.views(self._desk.clock()))

    def _go_after(self) -> None:
        view = self._desk.picture.view(self._desk.selected or "", self._desk.clock())
        if view is None or not view.has_pose:
            return
        ((x, y),) = self._desk.placement().to_map(np.array([(view.report.x, view.report.y)]))
        inner = self._desk.canvas.extent()
        inner.scale(FOLLOW_INSIDE)
        if not inner.contains(QgsPointXY(x, y)):
            self._desk.canvas.setCenter(QgsPointXY(x, y))
            self._desk.canvas.refresh()

    def _scene(self) -> Scene:
        desk, now = self._desk, self._desk.clock()
        robots = desk.picture.arrays(now)
        tasks = desk.book.under_way()
        return Scene(
            robots=robots,
            ages=[desk.picture.view(name, now).age for name in robots.names],
            selected=desk.selected,
            trails=desk.trails.arrays(now),
            targets=[target for task in tasks for target in _target(task)],
            paths=[path for task in tasks for path in _path(task)],
            draft=desk.drafts.draft,
            cursor=desk.drafts.cursor,
        )


def _target(task: CommandReport) -> list[Target]:
    if task.op == SetPath.__name__:
        return []
    point = (task.params.get("x"), task.params.get("y"))
    if not all(isinstance(value, (int, float)) for value in point):
        return []
    return [Target(task.robot, point, bool(task.params.get("cone")))]


def _path(task: CommandReport) -> list[np.ndarray]:
    if task.op != SetPath.__name__:
        return []
    return [np.array(task.params["points"], dtype=np.float64).reshape(-1, 2)]
