"""What an operator does in a shift, act by act; each leaves the desk as it found it.

No act waits for the gateway: the link may be down at any moment, and the desk has to bear that.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Generator

from qgis.core import QgsExpression, QgsExpressionContext, QgsProject
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAction,
    QApplication,
    QComboBox,
    QDialog,
    QLineEdit,
    QTableView,
    QTabWidget,
)
from qgis.utils import iface

from tests.support.inside_qgis.mouse import move_mouse
from tests.support.inside_qgis.operator_at_desk import NotHappenedError, OperatorAtDesk

LIVE_LAYER = "Robots (live)"
LEFT = Qt.MouseButton.LeftButton
Act = Callable[[], Generator[float, None, None]]
"""Yields the seconds that it takes its time for."""


class Shift:
    """Acts of an operator who works the window by its buttons, with robots of these names."""

    def __init__(self, operator: OperatorAtDesk, robots: list[str], seed: int) -> None:
        self._operator, self._robots = operator, robots
        self._chance = random.Random(seed)
        self._window, self._canvas = iface.mainWindow(), iface.mapCanvas()
        self._home = self._canvas.extent()

    def acts(self) -> list[Act]:
        """Return every act, in an order of this shift's own."""
        acts = [
            self.look_about,
            self.select_with_a_rectangle,
            self.send_a_cone_target,
            self.draw_routes,
            self.search_and_sort,
            self.leaf_through_the_lists,
            self.acknowledge_alarms,
            self.replay,
            self.open_the_panels,
            self.open_the_dialogs,
            self.follow,
            self.locate,
            self.ask_expressions,
            self.read_the_attribute_table,
            self.abort,
            self.stop_everything_and_clear,
        ]
        self._chance.shuffle(acts)
        return acts

    def put_away(self) -> None:
        """Put down what is in hand and list all robots; what is open stays open."""
        iface.actionPan().trigger()
        self._find(QLineEdit, "fleet_robot_search").clear()
        self._find(QComboBox, "fleet_robot_filter").setCurrentIndex(0)
        self._canvas.setRotation(0.0)
        self._look_at_home()

    def look_about(self) -> Generator[float, None, None]:
        """Zoom, turn, and go back; a card shows under the mouse."""
        for _ in range(3):
            self._canvas.zoomByFactor(0.6)
            move_mouse(self._canvas.viewport(), self._somewhere())
            yield 0.7
        self._canvas.setRotation(self._chance.uniform(5, 350))
        self._canvas.refresh()
        yield 1.0
        self._canvas.setRotation(0.0)
        self._look_at_home()
        yield 0.5

    def select_with_a_rectangle(self) -> Generator[float, None, None]:
        """Select robots on the map, then none."""
        self._operator.choose("fleet_select")
        view = self._canvas.viewport()
        begin, end = self._somewhere(), self._somewhere()
        QTest.mousePress(view, LEFT, Qt.KeyboardModifier.NoModifier, begin)
        try:
            for part in (0.3, 0.6, 1.0):
                move_mouse(view, begin + (end - begin) * part, LEFT)
                yield 0.05
        finally:
            QTest.mouseRelease(view, LEFT, Qt.KeyboardModifier.NoModifier, end)
        yield 1.0
        iface.actionPan().trigger()

    def send_a_cone_target(self) -> Generator[float, None, None]:
        """Send a robot, and draw a draft for another that is thrown away."""
        for wanted in ("fleet_send", "fleet_enqueue", "fleet_cancel"):
            self._select_one()
            yield 0.2
            self._operator.choose("fleet_cone_target")
            for _ in range(2):
                self._click_map()
                yield 0.3
            self._trigger(wanted)
            yield 0.6
        iface.actionPan().trigger()

    def draw_routes(self) -> Generator[float, None, None]:
        """Draw by hand, take points back, send; the way along roads is looked at only."""
        self._select_one()
        self._operator.choose("fleet_draw_route")
        for _ in range(4):
            self._click_map()
            yield 0.2
        for name in ("fleet_undo", "fleet_undo", "fleet_redo", "fleet_reverse_route", "fleet_send"):
            self._trigger(name)
            yield 0.2
        self._operator.choose("fleet_road_route")
        for _ in range(5):
            move_mouse(self._canvas.viewport(), self._somewhere())
            yield 0.3
        self._click_map()
        yield 0.3
        self._trigger("fleet_cancel")
        iface.actionPan().trigger()

    def search_and_sort(self) -> Generator[float, None, None]:
        """Narrow the table, sort it by each column, show the robots without a task."""
        search = self._find(QLineEdit, "fleet_robot_search")
        which = self._find(QComboBox, "fleet_robot_filter")
        header = self._find(QTableView, "fleet_robot_table").horizontalHeader()
        for text in ("robot-00", "robot fresh", ""):
            search.setText(text)
            yield 0.5
        for column in range(header.count()):
            if not header.isSectionHidden(column):
                at = QPoint(header.sectionViewportPosition(column) + 8, header.height() // 2)
                QTest.mouseClick(header.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, at)
                yield 1.1
        for index in (*range(which.count()), 0):
            which.setCurrentIndex(index)
            yield 0.5
        header.setSortIndicator(0, Qt.SortOrder.AscendingOrder)

    def leaf_through_the_lists(self) -> Generator[float, None, None]:
        """Show each list of the Fleet panel."""
        tabs = self._find(QTabWidget, "fleet_tabs")
        for index in (*range(tabs.count()), 0):
            self._select_one()
            tabs.setCurrentIndex(index)
            yield 1.2

    def acknowledge_alarms(self) -> Generator[float, None, None]:
        """Look at the alarms, say that they were seen, read their log."""
        tabs = self._find(QTabWidget, "fleet_tabs")
        tabs.setCurrentIndex(tabs.count() - 1)
        yield 1.0
        self._find(QAbstractButton, "fleet_acknowledge_all").click()
        yield 0.5
        self._find(QAbstractButton, "fleet_alarm_log").click()
        yield 1.0
        self._close("fleet_alarm_log_dialog")
        tabs.setCurrentIndex(0)

    def replay(self) -> Generator[float, None, None]:
        """Load the last five minutes of a few robots and play them beside the live map."""
        self._select_one()
        self._trigger("fleet_replay")
        yield 0.5
        self._find(QComboBox, "fleet_replay_last").setCurrentIndex(0)
        self._find(QAbstractButton, "fleet_replay_selected").setChecked(self._chance.random() < 0.7)
        load = self._find(QAbstractButton, "fleet_replay_load")
        load.click()
        yield 5.0
        self._find(QComboBox, "fleet_replay_speed").setCurrentIndex(4)
        play = self._find(QAbstractButton, "fleet_replay_play")
        play.click()
        yield 4.0
        play.click()
        yield 0.5
        self._trigger("fleet_replay")

    def open_the_panels(self) -> Generator[float, None, None]:
        """Show each other panel for a while."""
        for name in ("fleet_plan_panel", "fleet_observations"):
            self._trigger(name)
            yield 2.0
            self._trigger(name)
            yield 0.2

    def open_the_dialogs(self) -> Generator[float, None, None]:
        """Open each dialog and close it without a word."""
        dialogs = {
            "fleet_layer_roles": "fleet_roles_dialog",
            "fleet_coordinates": "fleet_coordinates_dialog",
            "fleet_help_action": "fleet_help",
        }
        for action, dialog in dialogs.items():
            self._select_one()
            self._trigger(action)
            yield 1.5
            self._close(dialog)
            yield 0.2

    def follow(self) -> Generator[float, None, None]:
        """Keep a robot in view, then all of them."""
        self._select_one()
        for name in ("fleet_follow", "fleet_follow_all"):
            self._trigger(name)
            yield 2.5
            self._trigger(name)
        self._look_at_home()

    def locate(self) -> Generator[float, None, None]:
        """Look for robots in QGIS's locator."""
        iface.locatorSearch(f"rb {self._chance.choice(self._robots)[:-1]}")
        yield 1.0
        iface.locatorSearch("")
        for widget in QApplication.topLevelWidgets():
            if type(widget).__name__ == "QFrame" and widget.isVisible():
                QTest.keyClick(widget, Qt.Key.Key_Escape)
        self._canvas.setFocus()

    def ask_expressions(self) -> Generator[float, None, None]:
        """Ask of robots and surfaces in expressions."""
        x, y = self._canvas.center().x(), self._canvas.center().y()
        robot = self._chance.choice(self._robots)
        for text in (
            f"robot_state('{robot}')",
            f"distance_to_robot('{robot}', make_point({x}, {y}))",
            f"road_surface({x}, {y})",
        ):
            QgsExpression(text).evaluate(QgsExpressionContext())
            yield 0.3

    def read_the_attribute_table(self) -> Generator[float, None, None]:
        """Open the attribute table of the live layer."""
        layers = QgsProject.instance().mapLayersByName(LIVE_LAYER)
        if layers:
            table = iface.showAttributeTable(layers[0])
            yield 3.0
            table.close()
        yield 0.2

    def abort(self) -> Generator[float, None, None]:
        """Abort one robot; now and then all of them."""
        self._select_one()
        self._operator.press("fleet_abort")
        yield 0.5
        if self._chance.random() < 0.3:
            self._find(QAbstractButton, "fleet_abort_all_button").click()
            yield 2.0

    def stop_everything_and_clear(self) -> Generator[float, None, None]:
        """Stop every robot, see it in force, clear it; in some shifts only."""
        if self._chance.random() > 0.25:
            return
        self._trigger("fleet_emergency_stop")
        yield 2.0
        for _ in range(20):
            self._trigger("fleet_clear_emergency")
            yield 0.5
            if self._window.findChild(QDialog, "fleet_clear_dialog") is not None:
                self._find(QLineEdit, "fleet_clear_reason").setText("the yard is free")
                self._find(QAbstractButton, "fleet_clear_confirm").click()
                yield 1.0
                return
            yield 1.0

    def _look_at_home(self) -> None:
        self._canvas.setExtent(self._home)
        self._canvas.refresh()

    def _select_one(self) -> None:
        self._operator.select(self._chance.choice(self._robots))

    def _click_map(self) -> None:
        at = self._somewhere()
        move_mouse(self._canvas.viewport(), at)
        QTest.mouseClick(self._canvas.viewport(), LEFT, Qt.KeyboardModifier.NoModifier, at)

    def _somewhere(self) -> QPoint:
        size = self._canvas.viewport().size()
        part = (self._chance.uniform(0.2, 0.8), self._chance.uniform(0.2, 0.8))
        return QPoint(round(size.width() * part[0]), round(size.height() * part[1]))

    def _trigger(self, name: str) -> None:
        self._find(QAction, name).trigger()

    def _close(self, dialog: str) -> None:
        found = self._window.findChild(QDialog, dialog)
        if found is not None:
            found.close()

    def _find(self, kind: type, name: str):
        found = self._window.findChild(kind, name)
        if found is None:
            raise NotHappenedError(f"the window has no {kind.__name__} named {name}; is the plugin loaded?")
        return found
