"""Tools in hand, and what a test reads off the panel."""

from __future__ import annotations

import pytest
from qgis.core import QgsFeature, QgsGeometry, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import QEvent, QPointF, Qt
from qgis.PyQt.QtGui import QMouseEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QLabel, QToolButton

X, Y = 488000.0, 5190000.0


class Hand:
    """The operator's hand on mouse and keys, and the eye on the panel."""

    def __init__(self, window, iface, gateway, wait):
        self.window, self.iface, self.gateway, self.wait = window, iface, gateway, wait
        self.drafts = window.desk.drafts

    @property
    def points(self):
        return self.drafts.draft.points if self.drafts.draft else None

    @property
    def draft_text(self) -> str:
        self.wait(self.iface.is_settled, what="the check of the draft")
        return self.window.dock.findChild(QLabel, "fleet_draft_text").text()

    def take(self, tool: str, robot: str | None = "r1") -> Hand:
        self.window.desk.selection.select(robot)
        getattr(self.window.actions, tool).trigger()
        return self

    def click(self, *points) -> None:
        for x, y in points:
            self.iface.click(x, y)

    def right_click(self, x, y) -> None:
        self.iface.click(x, y, Qt.MouseButton.RightButton)

    def key(self, key, *modifiers) -> None:
        held = Qt.KeyboardModifier.NoModifier
        for modifier in modifiers:
            held |= modifier
        QTest.keyClick(self.iface.canvas, key, held)
        self.wait(self.iface.is_settled, what="the check of the draft")

    def type(self, text: str) -> None:
        QTest.keyClicks(self.iface.canvas, text)

    def move(self, x, y) -> None:
        """Move the mouse, with no button down."""
        self._move(self.iface.pixel(x, y), Qt.MouseButton.NoButton)

    def drag(self, start, end, let_go: bool = True) -> None:
        view, none = self.iface.canvas.viewport(), Qt.KeyboardModifier.NoModifier
        left = Qt.MouseButton.LeftButton
        a, b = self.iface.pixel(*start), self.iface.pixel(*end)
        self._move(a, Qt.MouseButton.NoButton)
        QTest.mousePress(view, left, none, a)
        for part in (0.3, 0.7, 1.0):
            self._move(a + (b - a) * part, left)
        if let_go:
            QTest.mouseRelease(view, left, none, b)
            self.wait(self.iface.is_settled, what="the check of the draft")

    def _move(self, at, held) -> None:
        """Move as the window system does: QTest's own move says of no button that it is down."""
        view, none = self.iface.canvas.viewport(), Qt.KeyboardModifier.NoModifier
        where = QPointF(at), QPointF(view.mapToGlobal(at))
        event = QMouseEvent(QEvent.Type.MouseMove, *where, Qt.MouseButton.NoButton, held, none)
        QApplication.sendEvent(view, event)

    def push(self, name: str) -> None:
        button = self.window.dock.findChild(QToolButton, f"{name}_button")
        assert button.isEnabled(), name
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)
        self.wait(self.iface.is_settled, what="the check of the draft")

    def sent(self, count: int = 1) -> dict:
        self.wait(lambda: len(self.gateway.requests_of("send")) >= count, what="the command")
        return self.gateway.requests_of("send")[-1]

    def nothing_sent(self) -> bool:
        QTest.qWait(150)
        return self.gateway.requests_of("send") == [] and self.gateway.requests_of("add_tasks") == []

    def complained(self, *parts: str) -> bool:
        """Wait until one of ``parts`` stands in the message bar: a check may take its time."""
        self.wait(lambda: any(map(self.has_message, parts)), what=" or ".join(parts))
        return True

    def has_message(self, part: str) -> bool:
        return any(part in text for text in self.iface.texts())


@pytest.fixture
def hand(at_desk, iface, gateway, wait):
    return Hand(at_desk, iface, gateway, wait)


@pytest.fixture
def layer_of():
    """A layer of the project: ``layer_of("Point", wkt, ...)`` with coordinates in metres of the site."""

    def make(kind, *wkts, crs="EPSG:32633", role=None, names=(), name="things"):
        layer = QgsVectorLayer(f"{kind}?crs={crs}&field=name:string", name, "memory")
        features = []
        for number, wkt in enumerate(wkts):
            feature = QgsFeature(layer.fields())
            geometry = QgsGeometry.fromWkt(wkt)
            if crs == "EPSG:32633":
                geometry.translate(X, Y)
            feature.setGeometry(geometry)
            feature.setAttributes([names[number] if number < len(names) else None])
            features.append(feature)
        layer.dataProvider().addFeatures(features)
        if role is not None:
            layer.setCustomProperty("fleet/role", role)
        QgsProject.instance().addMapLayer(layer)
        return layer

    return make
