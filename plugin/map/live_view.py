"""Updates of the canvas from the desk: the overlay up to twenty times a second, the vector layer once, the
view as followed robots move."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from qgis.PyQt.QtCore import QObject, QTimer

from ..control.fleet_controller import FleetController
from ..control.messages import UNPLACED, Level
from ..gateway_client.robot_states import RemovedRobots
from ..gateway_client.state_words import part_in_words
from ..layers.live_layers import ProjectWatch
from ..layers.site_transform import SiteToMapTransform
from ..ui.errors import MapTransformError, Part, remove_all
from ..ui.language import tr
from ..ui.scheduling import PULL_EVERY_MS
from .overlay.fleet_overlay import FleetOverlay, HoverTracker, card
from .overlay.scene import FollowMode, SceneTransformer, SiteScene, TaskPaths, keep_in_view, show_places
from .overlay.task_painter import MANY
from .overlay.trails import Trails
from .reported_layers import RobotLayer

FRAME_MS = 15
"""Delay of a repaint after an action of the operator; robots are painted with each update."""
EVERY_SECOND = 1000 // PULL_EVERY_MS
EVERY_HALF = EVERY_SECOND // 2
PART_OF_THE_WINDOW = 0.5
"""Fraction of the window's time that painting may take; on a slow computer frames come less often."""
ZOOM_METRES = 30.0
SOUGHT_FOR_S = 5.0
"""Seconds to wait for the gateway's report of the position of a robot that was out of view."""
NEW_PLANS = 50
"""Plans made for one frame: a desk that connects receives a thousand at once."""


class LiveView(QObject):
    """Owns the overlay, the hover card and the robot layer."""

    def __init__(self, desk: FleetController, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._pulls = 0
        self.shown: tuple[int, int] = (0, 0)
        """The generation and revision of the desk's state that the overlay shows."""
        self._last_frame = self._took = 0.0
        self._placement: SiteToMapTransform | None = None
        """The desk's transform, None when it must be fetched again, which copies the canvas's settings."""
        self._is_unplaced = False
        """Whether the operator knows that the map cannot show the site."""
        self._placer = SceneTransformer()
        self._plans = TaskPaths()
        self._trails = Trails()
        self.following = FollowMode.NOBODY
        self._sought: tuple[str, float] | None = None
        """A robot to show once its position is known, and until when."""
        self._by_layer = False
        self.layer_every = EVERY_SECOND
        """Number of updates after which the layer of robots is written again."""
        self._parts: list[Part] = []
        """What :meth:`remove` takes out of QGIS, the last one first."""
        try:
            self._build()
        except Exception:
            # Nobody else knows this view yet.
            remove_all(self._parts)
            raise

    def _build(self) -> None:
        desk = self._desk
        self.overlay: FleetOverlay = self._add(FleetOverlay(desk.canvas, self._trails))
        self.layer: RobotLayer = self._add(RobotLayer(desk.project, desk.canvas, self))
        self._project = self._add(ProjectWatch(desk.project, self))
        self._hovering = self._add(HoverTracker(desk.canvas, self.overlay, self, self))
        self._frame = QTimer(self)
        self._frame.setSingleShot(True)
        self._frame.setInterval(FRAME_MS)
        self._frame.timeout.connect(self.show_now)
        self._after_pull = QTimer(self)
        self._after_pull.setSingleShot(True)
        self._after_pull.timeout.connect(self._show_pulled)
        self._after_frame = QTimer(self)
        self._after_frame.setSingleShot(True)
        self._after_frame.timeout.connect(self._write_layer)
        desk.state.updated.connect(self._pulled)
        desk.state.site_changed.connect(self._site_changed)
        desk.state.robots_removed.connect(self._robots_removed)
        desk.selection.changed.connect(self._selection_changed)
        desk.state.commands_changed.connect(self._frame.start)
        desk.drafts.changed.connect(self._frame.start)
        desk.drafts.pointed.connect(self._frame.start)
        desk.canvas.destinationCrsChanged.connect(self._way_changed)
        desk.project.transformContextChanged.connect(self._way_changed)
        desk.canvas.extentsChanged.connect(self._frame.start)
        self.layer.robots_selected.connect(self._selected_in_layer)

    def remove(self) -> None:
        """Remove the overlay and the card from the canvas and the layer from the project."""
        self._frame.stop()
        self._after_pull.stop()
        self._after_frame.stop()
        self._desk.canvas.destinationCrsChanged.disconnect(self._way_changed)
        self._desk.project.transformContextChanged.disconnect(self._way_changed)
        self._desk.canvas.extentsChanged.disconnect(self._frame.start)
        remove_all(self._parts)

    def _add(self, part: Any) -> Any:
        self._parts.append(part)
        return part

    def show_now(self) -> None:
        """Paint the desk's current state."""
        began = time.perf_counter()
        if self._desk.state.site is None:
            self.overlay.show_scene(None)
            return
        # Without the layer on the map there would be no robots at all.
        self.overlay.draw_arrows(not (self._by_layer and self.layer.layer in self._desk.canvas.layers()))
        try:
            if self._placement is None:
                self._placement = self._desk.site_to_canvas.transform()
            self.overlay.show_scene(self._placer.placed(self._scene(), self._placement))
            self._set_placed()
        except MapTransformError as error:
            self.overlay.show_scene(None)
            self._report_unplaced(error)
        self._last_frame = time.perf_counter()
        self._took = self._last_frame - began
        self.shown = self._desk.state.robots.generation, self._desk.state.robots.revision

    def _report_unplaced(self, error: MapTransformError) -> None:
        """Report why the map cannot show the site, once and not with each frame."""
        if not self._is_unplaced:
            self._is_unplaced = True
            self._desk.messages.post(str(error), Level.ERROR, UNPLACED)

    def _set_placed(self) -> None:
        """Withdraw the report that the map cannot show the site."""
        if self._is_unplaced:
            self._is_unplaced = False
            self._desk.messages.end(UNPLACED)

    def draw_by_layer(self, on: bool) -> None:
        """Let the style of the robot layer draw robots in place of arrows, where the layer is on the map."""
        self._by_layer = on
        self._frame.start()

    def zoom_to(self, *robots: str) -> None:
        """Show ``robots`` and their surroundings; a selected one out of view once its position is known."""
        self._sought = None
        now = self._desk.clock.steady()
        views = [self._desk.state.robots.view(robot, now) for robot in robots]
        placed = [view for view in views if view is not None and view.has_pose]
        if not placed:
            for robot in robots[:1]:
                if self._is_asked_for(robot):
                    self._sought = robot, now + SOUGHT_FOR_S
                else:
                    self._warn_of_no_position(robot)
            return
        self._show(np.array([(view.report.x, view.report.y) for view in placed]))

    def _is_asked_for(self, robot: str) -> bool:
        """Return whether the gateway will report the position of a robot unknown to the desk."""
        robots = self._desk.state.robots
        is_out_of_view = robots.fleet is not None and robots.row(robot) is None
        return is_out_of_view and robot in self._desk.selection.robots

    def _show_sought(self) -> None:
        if self._sought is None:
            return
        robot, until = self._sought
        if robot not in self._desk.selection.robots:
            self._sought = None
        elif not self._is_asked_for(robot):
            self.zoom_to(robot)
        elif self._desk.clock.steady() > until:
            self._sought = None
            self._warn_of_no_position(robot)

    def _warn_of_no_position(self, robot: str) -> None:
        self._desk.warning.emit(
            tr("{robot} has not said yet where it is; the map cannot go there.", robot=robot)
        )

    def show_place(self, x: float, y: float) -> None:
        """Show a place and its surroundings, metres in the site frame."""
        self._show(np.array([(x, y)]))

    def _show(self, at: np.ndarray) -> None:
        around = np.array([(dx, dy) for dx in (-1, 1) for dy in (-1, 1)]) * ZOOM_METRES
        corners = at[:, None, :] + around
        try:
            transform = self._desk.site_to_canvas.transform()
            places = transform.to_map_or_nan(corners)
            places = places[np.isfinite(places[:, 0, 0])]
            if len(places):
                show_places(self._desk.canvas, places.reshape(-1, 2))
            if len(places) < len(at):
                # It raises the reason.
                transform.to_map(corners.reshape(-1, 2))
        except MapTransformError as error:
            self._desk.warning.emit(str(error))

    def follow(self, mode: FollowMode) -> None:
        """Keep the selected robots or all of them in view, or stop doing so."""
        self.following = mode
        if mode is FollowMode.ALL and (part := part_in_words(self._desk.state.robots)):
            self._desk.warning.emit(f"{tr('All robots cannot be followed.')} {part}")
        if mode is FollowMode.SELECTED and not self._desk.selection.robots:
            self._desk.warning.emit(
                tr("No robot is selected to be followed. Select one in the table or on the map.")
            )

    def _pulled(self) -> None:
        self._pulls += 1
        # In an event of its own: the lists that show the news are painted in this one.
        self._after_pull.start(0)
        self._show_sought()

    def _show_pulled(self) -> None:
        picture = self._desk.state.robots
        is_whole = self._plans.is_whole and self.overlay.is_whole
        is_new = self.shown != (picture.generation, picture.revision) or not is_whole
        rested = time.perf_counter() - self._last_frame
        costs = self._took + self.overlay.took
        if (is_new or self._pulls % EVERY_HALF == 0) and rested >= costs * (1 / PART_OF_THE_WINDOW - 1):
            self.show_now()
        if self._pulls % EVERY_HALF == 0:
            self._hovering.refresh()
        # In an event of its own: it takes as long as the frame.
        self._after_frame.start(0)
        if self._pulls % EVERY_SECOND == 0:
            self._go_after()

    def _site_changed(self) -> None:
        if not self._project.is_reading:
            self.layer.show_site(self._desk.state.site)
        if self.shown[0] != self._desk.state.robots.generation:
            # The map must not show another gateway's reports even for a moment.
            self.overlay.show_scene(None)
            self.layer.clear()
            self._trails.clear()
        self._way_changed()

    def _robots_removed(self, gone: RemovedRobots) -> None:
        self._trails.drop(gone.rows)
        self.layer.drop(gone.all_names)
        self._frame.start()

    def _way_changed(self) -> None:
        """Place everything again: the site, the map's CRS, or the operations to it, have changed."""
        self._placement = None
        self._set_placed()
        self._frame.start()

    def _selection_changed(self) -> None:
        self.layer.mark(self._desk.selection.robots)
        self._frame.start()

    def _selected_in_layer(self, robots: list[str]) -> None:
        # The robot that drafts are made for remains so as long as it is among them.
        self._desk.selection.select_all(sorted(robots, key=lambda robot: robot == self._desk.selection.last))

    def _write_layer(self) -> None:
        if self._project.is_reading:
            return
        if self._desk.state.site is not None and self.layer.layer is None:
            # The project with the layer was closed; the robots are still there.
            self.layer.show_site(self._desk.state.site)
        newcomers = len(self._desk.state.robots) != len(self.layer)
        if self._pulls % self.layer_every == 0 or newcomers:
            self.layer.begin(len(self._desk.state.robots))
        self.layer.go_on(self._desk.state.robots, self._desk.clock.steady())
        if self.layer.is_new:
            self.layer.mark(self._desk.selection.robots)

    def _go_after(self) -> None:
        if self.following is FollowMode.NOBODY or self._desk.state.site is None:
            return
        if self.following is FollowMode.ALL and self._desk.state.robots.fleet is not None:
            # Those in view are not the fleet: following them, the map would never show others.
            return
        robots = self._desk.state.robots.arrays(self._desk.clock.steady())
        xy = robots.xy
        if self.following is FollowMode.SELECTED:
            rows = [self._desk.state.robots.row(name) for name in self._desk.selection.robots]
            xy = xy[[row for row in rows if row is not None]]
        there = xy[np.isfinite(xy).all(axis=1)]
        try:
            places = self._desk.site_to_canvas.transform().to_map_or_nan(there)
        except MapTransformError:
            # The frame reports it.
            return
        keep_in_view(self._desk.canvas, self.overlay.screen(), places)

    def _scene(self) -> SiteScene:
        desk, now = self._desk, self._desk.clock.steady()
        robots = desk.state.robots.arrays(now)
        self._trails.extend(robots.xy, now)
        plans = self._plans.of(desk.state.commands.under_way(), NEW_PLANS)
        measured = (
            plans if len(plans) <= MANY else [p for p in plans if p.robot in desk.selection.robots][:MANY]
        )
        named = {*desk.selection.robots, *(plan.robot for plan in measured)}
        if desk.drafts.draft is not None:
            named.add(desk.drafts.draft.robot)
        rows = {name: row for name in named if (row := desk.state.robots.row(name)) is not None}
        return SiteScene(
            robots=robots,
            now=now,
            chosen=desk.selection.robots,
            plans=plans,
            remaining={
                plan.command: self._plans.remaining(plan, robots.xy[rows[plan.robot]])
                for plan in measured
                if plan.robot in rows and np.isfinite(robots.xy[rows[plan.robot]]).all()
            },
            draft=desk.drafts.draft,
            cursor=desk.drafts.cursor,
            fleet=desk.state.robots.fleet,
            rows=rows,
        )

    def card_text(self, robot: str) -> str | None:
        """Return a robot's details as rich text, None where it is no longer known."""
        view = self._desk.state.robots.view(robot, self._desk.clock.steady())
        if view is None or self._desk.state.site is None:
            return None
        task = self._desk.state.commands.task_of(robot)
        left = None
        if task is not None and view.has_pose:
            for plan in self._plans.of(self._desk.state.commands.under_way()):
                if plan.robot == robot:
                    left = self._plans.remaining(plan, np.array([view.report.x, view.report.y]))
        return card(view, task, left, self._desk.site_to_canvas.transform().frame)
