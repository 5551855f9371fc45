"""Card beside the mouse: what is known of the robot under it, whichever map tool is active."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, QRect, Qt
from qgis.PyQt.QtGui import QFont
from qgis.PyQt.QtWidgets import QLabel, QToolTip, QWidget

from ....robot_bridge.core.geometry import heading_of
from ....robot_bridge.core.messages import CommandReport
from ....robot_bridge.core.sites.frame import SiteFrame
from ...gateway_client.command_cache import command_in_words
from ...gateway_client.robot_states import RobotView
from ...gateway_client.state_texts import COMMAND_STATES, ROBOT_STATES
from ...ui.glyphs import STATE_COLOURS
from ...ui.language import tr
from .fleet_overlay import FleetOverlay
from .labels import age_in_words

# --- The card beside the mouse: what is known of the robot under it ---

AWAY = QPoint(18, 14)
"""From the mouse to the card."""


class HoverCard(QLabel):
    """A card over the canvas that lets every click through."""

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
        """Show ``text`` beside the mouse, whole.

        Not below it at the right as long as there is another place: that is where map tools have their tips.
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
    """Return what is known of a robot as rich text; what it has not said is left out."""
    report = view.report
    colour = STATE_COLOURS[view.state].name()
    head = (
        f'<b>{escape(view.name)}</b> &nbsp;<span style="color:{colour}">■</span> {ROBOT_STATES[view.state]}'
    )
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
    if report.status:
        rows.append((tr("it says"), escape(report.status)))
    cells = "".join(f"<tr><td>{name}&nbsp;&nbsp;</td><td>{value}</td></tr>" for name, value in rows)
    return f"{head}<table>{cells}</table>"


def _smaller(font: QFont) -> QFont:
    """Return a size less than ``font``: a card covers a part of the map."""
    less = QFont(font)
    less.setPointSizeF(max(7.5, font.pointSizeF() - 1.0))
    return less


# --- Watches the mouse over the canvas, whichever map tool is in hand, and shows the card of the robot there

_MOVE = QEvent.Type.MouseMove
_ENDS = (QEvent.Type.Leave, QEvent.Type.MouseButtonPress)
"""Looked up once: every event of the canvas comes by here, and there are many to a frame."""


class HoverTracker(QObject):
    """``card_of`` returns the text of a robot's card, None when it is not known any more."""

    def __init__(
        self,
        canvas: QgsMapCanvas,
        overlay: FleetOverlay,
        card_of: Callable[[str], str | None],
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self._overlay = overlay
        self._card_of = card_of
        self._mouse: QPoint | None = None
        self._viewport = canvas.viewport()
        self._card = HoverCard(self._viewport)
        self._viewport.installEventFilter(self)

    def remove(self) -> None:
        """Take the card off the canvas."""
        self._mouse = None
        if not sip.isdeleted(self._viewport):
            self._viewport.removeEventFilter(self)
        if not sip.isdeleted(self._card):
            self._card.setParent(None)
            self._card.deleteLater()

    def refresh(self) -> None:
        """Show the card of the robot that is now under the mouse, which may not have moved."""
        robot = None
        if self._mouse is not None:
            robot = self._overlay.robot_at(self._mouse.x(), self._mouse.y())
        text = self._card_of(robot) if robot is not None else None
        if text is None:
            self._card.hide()
        else:
            self._card.show_at(text, self._mouse)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if kind == _MOVE:
            # While something is dragged a card would be in the way.
            free = event.buttons() == Qt.MouseButton.NoButton
            self._mouse = event.pos() if free else None
            self.refresh()
        elif kind in _ENDS:
            self._mouse = None
            self.refresh()
        return False
