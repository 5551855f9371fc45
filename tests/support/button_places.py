"""Where buttons are on the screen, and which of them have moved."""

from __future__ import annotations

from qgis.PyQt.QtCore import QPoint, QRect
from qgis.PyQt.QtWidgets import QAbstractButton, QApplication, QLineEdit, QPushButton, QToolButton


def places(*windows) -> dict[str, QRect]:
    """Return where on the screen each push button and tool button in ``windows`` is seen, by its name."""
    return {
        f"{button.objectName() or button.text()}": QRect(button.mapToGlobal(QPoint(0, 0)), button.size())
        for window in windows
        for button in window.findChildren(QAbstractButton)
        if isinstance(button, (QPushButton, QToolButton))
        and button.isVisible()
        and not isinstance(button.parent(), QLineEdit)
    }


class Watched:
    """Holds the buttons of a panel against where they were at first."""

    def __init__(self, *panels):
        self._panels = panels
        self._were: dict[str, QRect] = {}
        self.check("at first")

    def check(self, when: str) -> None:
        """Look at the buttons; one that is seen for the first time may be anywhere."""
        for _ in range(3):
            QApplication.processEvents()
        moved = self.moved()
        assert not moved, f"{when}: {moved}"

    def moved(self) -> list[str]:
        """Return in words which buttons are elsewhere than before."""
        now = places(*self._panels)
        moved = [
            f"{name} was at {self._were[name].getRect()} and is at {at.getRect()}"
            for name, at in now.items()
            if self._were.get(name, at) != at
        ]
        self._were.update(now)
        return moved
