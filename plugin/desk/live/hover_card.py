"""The card beside the mouse: what is known of the robot under it."""

from __future__ import annotations

from html import escape

from qgis.PyQt.QtCore import QPoint, QRect, Qt
from qgis.PyQt.QtGui import QFont
from qgis.PyQt.QtWidgets import QLabel, QToolTip, QWidget

from ....robot_bridge.compass import heading_of
from ....robot_bridge.messages import CommandReport
from ....robot_bridge.sites.frame import SiteFrame
from ...language import tr
from ..colours import STATE_COLOURS
from ..command_book import in_words
from ..picture import RobotView
from ..state_words import COMMAND_STATES, ROBOT_STATES
from .labels import age_in_words

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
        rows.append((tr("task"), f"{escape(in_words(task))}: {COMMAND_STATES[task.state]}{left}"))
    if report.status:
        rows.append((tr("it says"), escape(report.status)))
    cells = "".join(f"<tr><td>{name}&nbsp;&nbsp;</td><td>{value}</td></tr>" for name, value in rows)
    return f"{head}<table>{cells}</table>"


def _smaller(font: QFont) -> QFont:
    """Return a size less than ``font``: a card covers a part of the map."""
    less = QFont(font)
    less.setPointSizeF(max(7.5, font.pointSizeF() - 1.0))
    return less
