"""What an operator sees and presses in the Fleet panel."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QTableView

LEFT = Qt.MouseButton.LeftButton


def press(window, kind, name):
    QTest.mouseClick(window.dock.findChild(kind, name), LEFT)


def state_line(window):
    return window.dock.findChild(QLabel, "fleet_link_state").text()


def table(window):
    view = window.dock.findChild(QTableView, "fleet_robot_table")
    model = view.model()
    titles = [model.headerData(c, Qt.Orientation.Horizontal) for c in range(model.columnCount())]
    return view, [
        {title: model.index(row, column).data() for column, title in enumerate(titles)}
        for row in range(model.rowCount())
    ]
