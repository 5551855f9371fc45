"""Watches the mouse over the canvas, whichever map tool is in hand, and shows the card of the robot there."""

from __future__ import annotations

from collections.abc import Callable

from qgis.gui import QgsMapCanvas
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt

from .hover_card import HoverCard
from .overlay import FleetOverlay

_MOVE = QEvent.Type.MouseMove
_ENDS = (QEvent.Type.Leave, QEvent.Type.MouseButtonPress)
"""Looked up once: every event of the canvas comes by here, and there are many to a frame."""


class Hovering(QObject):
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
