"""The canvas item of the overlay, its painting order, and the hover card."""

from __future__ import annotations

import time
from html import escape
from typing import Protocol

import numpy as np
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, QRect, QRectF, Qt
from qgis.PyQt.QtGui import QFont, QPainter
from qgis.PyQt.QtWidgets import QLabel, QStyleOptionGraphicsItem, QToolTip, QWidget

from ....robot_bridge.core.geometry import heading_of
from ....robot_bridge.core.messages.commands import CommandReport
from ....robot_bridge.core.sites.frame import SiteFrame
from ...gateway_client.command_cache import command_in_words
from ...gateway_client.robot_states import UNSURE, RobotView
from ...gateway_client.state_words import COMMAND_STATES, robot_state_in_words
from ...ui.glyphs import STATE_COLOURS, UNSURE_COLOUR
from ...ui.language import tr
from .grouped_robots import BorderHints, DensityPainter, Hint
from .labels import Labels, NamesPainter, age_in_words
from .robots_painter import CirclesPainter, RobotsPainter
from .scene import InView, MapScene, Screen, in_view, screen_of
from .task_painter import PathsPainter, PendingCommandPainter
from .trails import TrailImage, Trails


class ScenePainter:
    """Paints scenes; caches the images that it paints repeatedly."""

    def __init__(self, trails: Trails | None = None) -> None:
        self._labels = Labels()
        self._trails = TrailImage(Trails() if trails is None else trails)
        self._plans = PathsPainter(self._labels)
        self._draft = PendingCommandPainter()
        self._density = DensityPainter(self._labels)
        self.robots = RobotsPainter()
        self._names = NamesPainter()
        self._borders = BorderHints()
        self._circles = CirclesPainter()
        self._viewed: tuple[MapScene, Screen, InView] | None = None

    @property
    def hints(self) -> list[Hint]:
        """The arrows at the border that were painted last."""
        return self._borders.hints

    @property
    def is_whole(self) -> bool:
        """Whether everything is painted, so that no more frames are needed."""
        return self._plans.is_whole and self._circles.is_whole

    def prepare(self, placed: MapScene | None, screen: Screen) -> None:
        """Prepare a new scene: draw what is needed once and not in each frame.

        The same scene is prepared again while it is not complete, or when the screen has changed.
        """
        if placed is None:
            self._trails.forget()
            self._viewed = None
            return
        view = self._view(placed, screen)
        self._trails.extend(placed.robots, screen, placed.transform, placed.scene.now, view.pixels)
        self._circles.prepare(placed, view, screen)
        self.robots.prepare(placed, view, screen)
        self._plans.prepare(placed, screen, self.robots.marks)

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint the scene that was prepared last."""
        view = self._view(placed, screen)
        self._density.paint(painter, placed, screen)
        self._trails.paint(painter, screen)
        self._circles.paint(painter, placed, screen)
        self._plans.paint(painter, placed, view.pixels, screen, self.robots.marks)
        self._draft.paint(painter, placed, view.pixels, screen, self.robots.marks)
        self.robots.paint(painter, placed, view, screen)
        is_busy = self._borders.find(placed, view, screen)
        taken = [(x - 24.0, y, x + 24.0, y + 26.0) for x, y in self._plans.distances]
        taken += [hint.area for hint in self.hints]
        self._names.paint(painter, placed, view, screen, taken, may_wait=is_busy)
        self._borders.paint(painter, placed, screen)

    def _view(self, placed: MapScene, screen: Screen) -> InView:
        """Return the robots in view on ``screen``, computed once for each scene and screen."""
        if self._viewed is None or self._viewed[0] is not placed or self._viewed[1] != screen:
            self._viewed = placed, screen, in_view(placed, screen)
        return self._viewed[2]


_FILLED = Qt.WidgetAttribute.WA_OpaquePaintEvent
NEAR = 18.0
"""Distance in pixels within which a click selects a robot."""


class FleetOverlay(QgsMapCanvasItem):
    """Covers the whole viewport and paints the latest scene, in the map's CRS."""

    def __init__(self, canvas: QgsMapCanvas, trails: Trails | None = None):
        super().__init__(canvas)
        self._canvas = canvas
        self._placed: MapScene | None = None
        self._painter = ScenePainter(trails)
        self.took = 0.0
        """Duration of the last painting, seconds."""
        self.frames = 0
        """Number of paintings."""
        self.setZValue(90)

    def show_scene(self, placed: MapScene | None) -> None:
        """Paint ``placed`` from now on, None for nothing."""
        self._placed = placed
        self.prepare()

    def prepare(self) -> None:
        """Continue with incomplete parts of the scene, for the present view of the canvas."""
        viewport = self._canvas.viewport()
        # Qt fills a viewport before the scene does so itself: a sixth of the time for painting the map.
        viewport.setAttribute(_FILLED, self._canvas.backgroundBrush().isOpaque())
        self._painter.prepare(self._placed, self.screen(viewport.devicePixelRatioF()))
        self.update()

    def remove(self) -> None:
        """Remove the item from the canvas, which is restored; the canvas may have deleted it before."""
        if sip.isdeleted(self):
            return
        self._canvas.viewport().setAttribute(_FILLED, False)
        self._canvas.scene().removeItem(self)

    def boundingRect(self) -> QRectF:
        return QRectF(0, 0, self._canvas.width(), self._canvas.height())

    def updatePosition(self) -> None:
        self.prepareGeometryChange()
        self.setPos(0, 0)

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem | None = None, widget: QWidget | None = None
    ) -> None:
        if self._placed is None:
            return
        began = time.perf_counter()
        ratio = painter.device().devicePixelRatioF() if painter.device() else 1.0
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._painter.paint(painter, self._placed, self.screen(ratio))
        painter.restore()
        self.took = time.perf_counter() - began
        self.frames += 1

    @property
    def is_whole(self) -> bool:
        """Whether everything is painted, so that no more frames are needed."""
        return self._painter.is_whole

    def magnify(self, times: float) -> None:
        """Draw robots magnified by this factor."""
        self._painter.robots.set_magnification(times)
        self.update()

    def draw_arrows(self, on: bool) -> None:
        """Draw an arrow for each robot, or leave that to the layer; the rest is always drawn."""
        self._painter.robots.draw_arrows(on)

    def robot_at(self, x: float, y: float) -> str | None:
        """Return the robot nearest to pixel (x, y), None when there is none nearby."""
        pixels = self._pixels()
        if len(pixels) == 0:
            return None
        away = np.hypot(*(pixels - (x, y)).T)
        nearest = int(np.where(np.isfinite(away), away, np.inf).argmin())
        return self._placed.scene.robots.names[nearest] if away[nearest] <= NEAR else None

    def robots_in(self, area: QRect) -> list[str]:
        """Return the robots whose positions are in ``area``, in pixels."""
        x, y = self._pixels().T
        inside = (x >= area.left()) & (x <= area.right()) & (y >= area.top()) & (y <= area.bottom())
        return [self._placed.scene.robots.names[row] for row in np.flatnonzero(inside).tolist()]

    def robots_beyond(self, x: float, y: float) -> list[str]:
        """Return the robots beyond the border that the arrow at pixel (x, y) stands for."""
        for hint in self._painter.hints if self._placed else []:
            if np.hypot(hint.x - x, hint.y - y) <= NEAR:
                return [self._placed.scene.robots.names[row] for row in hint.rows.tolist()]
        return []

    def screen(self, ratio: float = 1.0) -> Screen:
        """Return the screen for the present view of the canvas."""
        return screen_of(self._canvas, self, ratio)

    def _pixels(self) -> np.ndarray:
        if self._placed is None:
            return np.empty((0, 2))
        return self.screen().pixels(self._placed.robots)


AWAY = QPoint(18, 14)
"""Offset of the card from the mouse."""


class HoverCard(QLabel):
    """A card over the canvas, transparent for clicks."""

    def __init__(self, parent: QWidget):
        super().__init__(parent)
        self.setObjectName("fleet_hover_card")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setTextFormat(Qt.TextFormat.RichText)
        self.setPalette(QToolTip.palette())
        self.setFont(_smaller(QToolTip.font()))
        self.setAutoFillBackground(True)
        self.setFrameShape(QLabel.Shape.Box)
        self.setMargin(6)
        self.hide()

    def show_at(self, text: str, mouse: QPoint) -> None:
        """Show ``text`` beside the mouse, completely visible.

        Below it at the right only if there is no other place: map tools show their tips there.
        """
        self.setText(text)
        self.adjustSize()
        area = self.parentWidget().rect()
        right, left = mouse.x() + AWAY.x(), mouse.x() - AWAY.x() - self.width()
        above, below = mouse.y() - AWAY.y() - self.height(), mouse.y() + AWAY.y()
        places = [QRect(QPoint(x, y), self.size()) for x, y in ((right, above), (left, above), (left, below))]
        free = next((place.topLeft() for place in places if area.contains(place)), None)
        self.move(free or QPoint(max(0, min(right, area.right() - self.width())), below))
        self.show()


def card(view: RobotView, task: CommandReport | None, remaining: float | None, frame: SiteFrame) -> str:
    """Return a robot's details as rich text; unreported ones are left out."""
    report = view.report
    colour = (UNSURE_COLOUR if view.shown_as == UNSURE else STATE_COLOURS[view.state]).name()
    state = robot_state_in_words(view)
    head = f'<b>{escape(view.name)}</b> &nbsp;<span style="color:{colour}">■</span> {state}'
    rows = [
        (
            tr("last message"),
            tr(
                "{age_in_words} ago, {escape}",
                age_in_words=age_in_words(view.age),
                escape=escape(report.link),
            ),
        )
    ]
    if view.has_pose:
        rows.append((tr("place"), tr("{x:.2f}, {y:.2f} m in the site", x=report.x, y=report.y)))
    if report.accuracy is not None:
        rows.append((tr("accuracy"), tr("± {accuracy:.2f} m", accuracy=report.accuracy)))
    if report.theta is not None:
        heading = heading_of(frame.theta_to_crs(report.theta))
        rows.append((tr("heading"), f"{heading:.0f}°"))
    if report.v is not None:
        rows.append((tr("speed"), tr("{v:.2f} m/s", v=report.v)))
    if report.battery is not None:
        rows.append((tr("battery"), f"{report.battery:.0%}"))
    if task is not None:
        left = "" if remaining is None else tr(", {remaining:.1f} m to go", remaining=remaining)
        rows.append((tr("task"), f"{escape(command_in_words(task))}: {COMMAND_STATES[task.state]}{left}"))
    if report.doubt:
        rows.append((tr("why"), escape(report.doubt)))
    if report.status and report.status != report.doubt:
        rows.append((tr("it says"), escape(report.status)))
    cells = "".join(f"<tr><td>{name}&nbsp;&nbsp;</td><td>{value}</td></tr>" for name, value in rows)
    return f"{head}<table>{cells}</table>"


def _smaller(font: QFont) -> QFont:
    """Return ``font`` one size smaller: a card covers a part of the map."""
    less = QFont(font)
    less.setPointSizeF(max(7.5, font.pointSizeF() - 1.0))
    return less


_MOVE = QEvent.Type.MouseMove
_ENDS = (QEvent.Type.Leave, QEvent.Type.MouseButtonPress)
"""A constant, as every event of the canvas is compared with it, many per frame."""


class CardTexts(Protocol):
    """The provider of the texts of cards."""

    def card_text(self, robot: str) -> str | None:
        """Return the text of a robot's card, None when it is no longer known."""


class HoverTracker(QObject):
    """Shows the card of the robot under the mouse, with its text from ``cards``."""

    def __init__(
        self,
        canvas: QgsMapCanvas,
        overlay: FleetOverlay,
        cards: CardTexts,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._overlay = overlay
        self._cards = cards
        self._mouse: QPoint | None = None
        self._viewport = canvas.viewport()
        self._card = HoverCard(self._viewport)
        self._viewport.installEventFilter(self)

    def remove(self) -> None:
        """Remove the card from the canvas."""
        self._mouse = None
        if not sip.isdeleted(self._viewport):
            self._viewport.removeEventFilter(self)
        if not sip.isdeleted(self._card):
            self._card.setParent(None)
            self._card.deleteLater()

    def refresh(self) -> None:
        """Show the card of the robot now under the mouse, which may not have moved."""
        robot = None
        if self._mouse is not None:
            robot = self._overlay.robot_at(self._mouse.x(), self._mouse.y())
        text = self._cards.card_text(robot) if robot is not None else None
        if text is None:
            self._card.hide()
        else:
            self._card.show_at(text, self._mouse)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind == _MOVE:
            # While dragging a card would be in the way.
            free = event.buttons() == Qt.MouseButton.NoButton
            self._mouse = event.pos() if free else None
            self.refresh()
        elif kind in _ENDS:
            self._mouse = None
            self.refresh()
        return False
