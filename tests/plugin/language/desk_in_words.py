"""Opens what the plugin shows, in one language and look, and tells what is cut off.

python -m tests.plugin.language.desk_in_words LANGUAGE RESULT.json [--theme NAME] [--pictures FOLDER]

LANGUAGE is a locale such as hu, or ``stretched``. In a process of its own: constants of modules take their
language when they are imported. RESULT.json has, by the name of each part, what is wrong with it.

More of them, apart by ``and``, are looked at one after the other, each in a process that is forked off this
one: half of what one takes is to load QGIS.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import pkgutil
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from qgis.core import QgsApplication, QgsProject, QgsSettings
from qgis.PyQt.QtCore import QCoreApplication, QEvent, QSettings, QSize, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QApplication,
    QDialog,
    QDialogButtonBox,
    QDockWidget,
    QMainWindow,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from tests.conftest import register_plugin_package
from tests.plugin.language.stretched import StretchedLanguage
from tests.support.inside_qgis.cut_off import cut_off, too_large

ROOT = Path(__file__).resolve().parents[3]
ROOM = QSize(1280, 800)
"""The smallest screen that the desk is made for."""
OPTIONS_ROOM = QSize(960, 620)
"""What QGIS's options, as large as such a screen, leave for a page."""
LAYERS_WIDTH = 200
"""Pixels of QGIS's panel at the left, in which the names of layers can be read."""
MAP_AT_LEAST = 400
"""Pixels of width that are left for the map between that and the fleet panel."""
ROWS_AT_LEAST = 4
"""Robots that are seen at once, whatever else there is to be told."""
PANELS = ("observation_dock", "replay_dock", "plan_dock")


def speak(language: str):
    """Install a language before anything of the plugin is imported; return what keeps it."""
    if language == "stretched":
        stretched = StretchedLanguage()
        QCoreApplication.installTranslator(stretched)
        return stretched
    from fleet_supervisor.plugin.ui.language import Language

    return Language(language)


class Show:
    """Each part of the plugin in turn, with something in it."""

    def __init__(self, pictures: Path | None):
        self._pictures = pictures
        self.faults: dict[str, list[str]] = {}
        self.watched = None
        """What holds the fleet panel's buttons against where they were, while the link is up."""

    def look(self, name: str, widget: QWidget, room: QSize = ROOM) -> None:
        """Take down what is wrong with ``widget``, and its picture."""
        if isinstance(widget, QMainWindow):
            make_panels_narrow(widget)
            widget.resize(room)
        settle()
        if widget.isWindow():
            # A platform without a window manager does not do what the layout asks for.
            widget.resize(widget.size().expandedTo(widget.minimumSizeHint()))
            settle()
        found = [*too_large(widget, room), *cut_off(widget)]
        if self.watched is not None:
            found += self.watched.moved()
        if found:
            self.faults[name] = found
        if self._pictures is not None:
            widget.grab().save(str(self._pictures / f"{name}.png"))

    def dialog(self, name: str, dialog: QDialog) -> None:
        """Look at a dialog and close it."""
        dialog.open()
        self.look(name, dialog)
        dialog.close()
        dialog.deleteLater()
        settle()


def make_panels_narrow(window: QMainWindow) -> None:
    """Drag the edges of the panels until they give way no more, as QGIS does where room is short."""
    docks = [dock for dock in window.findChildren(QDockWidget) if dock.isVisible()]
    window.resizeDocks(docks, [1] * len(docks), Qt.Orientation.Horizontal)


def settle() -> None:
    """Let Qt lay out, paint and delete."""
    for _ in range(3):
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        QTest.qWait(20)


def load_what_has_no_words() -> None:
    """Load once for all desks what says nothing to an operator: QGIS, and what the bridge shares."""
    register_plugin_package()
    import fleet_supervisor.robot_bridge.core as core

    import tests.plugin.conftest  # noqa: F401

    for module in pkgutil.walk_packages(core.__path__, f"{core.__name__}."):
        importlib.import_module(module.name)


def main() -> None:
    """Look at one desk after the other, each in a process of its own; end with the first bad status."""
    load_what_has_no_words()
    words = sys.argv[1:]
    while True:
        end = words.index("and") if "and" in words else len(words)
        desk, words = words[:end], words[end + 1 :]
        child = os.fork()
        if not child:
            look_at_desk(desk)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if status or not words:
            sys.exit(status)


def look_at_desk(words: list[str]) -> NoReturn:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("language")
    parser.add_argument("result", type=Path)
    parser.add_argument("--theme")
    parser.add_argument("--points", type=int, help="size of the font")
    parser.add_argument("--pictures", type=Path)
    wanted = parser.parse_args(words)
    if wanted.pictures is not None:
        wanted.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="fleet-words-") as folder:
        QSettings.setPath(QSettings.Format.NativeFormat, QSettings.Scope.UserScope, folder)
        QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)
        QCoreApplication.setOrganizationName("fleet-words")
        application = QgsApplication([], True, folder)
        application.initQgis()
        if wanted.theme:
            QgsApplication.setUITheme(wanted.theme)
        if wanted.points:
            font = QApplication.font()
            font.setPointSize(wanted.points)
            QApplication.setFont(font)
        language = speak(wanted.language)
        show = Show(wanted.pictures)
        show_all(show)
        wanted.result.write_text(json.dumps(show.faults, indent=1, ensure_ascii=False), encoding="utf-8")
        del language
    # Not by way of Python's tidying up: QGIS's objects and Qt's would be gone in an order that Qt ends on.
    sys.stdout.flush()
    os._exit(0)


def show_all(show: Show) -> None:
    """Load the plugin into a window, connect it, and look at all of it."""
    from fleet_supervisor.plugin.plugin import FleetPlugin

    from tests.plugin import conftest as desk_tests
    from tests.plugin.language.every_dialog import dialogs

    QgsSettings().setValue("fleet_supervisor/tour_offered", True)
    window = desk_tests.Window()
    arrange_as_qgis_does(window)
    window.resize(ROOM)
    window.show()
    gateway = desk_tests.SmallGateway(yard())
    gateway.start()
    plugin = FleetPlugin(window)
    plugin.initGui()
    try:
        look_at_panel(show, window, plugin.window, gateway, desk_tests)
        look_at_docks(show, window, plugin, desk_tests)
        for name, dialog in dialogs(window, plugin.window):
            show.dialog(name, dialog)
        look_at_options(show, window)
        look_at_tour(show, window)
    finally:
        plugin.unload()
        gateway.stop()
        window.canvas.stopRendering()
        window.close()
        QgsProject.instance().clear()
        settle()


def arrange_as_qgis_does(window) -> None:
    """Put a panel at the left, and the message bar over the map: what it needs, the window needs."""
    middle = QWidget()
    rows = QVBoxLayout(middle)
    rows.setContentsMargins(0, 0, 0, 0)
    window.bar.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Fixed)
    rows.addWidget(window.bar)
    rows.addWidget(window.takeCentralWidget(), 1)
    window.setCentralWidget(middle)
    layers = QDockWidget("Layers", window)
    layers.setWidget(QWidget())
    layers.widget().setFixedWidth(LAYERS_WIDTH)
    window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, layers)


def yard():
    from fleet_supervisor.robot_bridge.core.messages.administration import SiteReport

    return SiteReport(
        id="yard",
        name="Sample proving ground and campus",
        version="1",
        crs="EPSG:32633",
        origin=(488000.0, 5190000.0),
        rotation=0.0,
        bounds=(0.0, 0.0, 200.0, 160.0),
        reached_tolerance=0.2,
        # Else the alarm of silent robots is back before all is looked at, and its bar with it.
        stale_after=3600.0,
        lost_after=7200.0,
    )


def look_at_panel(show: Show, window, desk_window, gateway, desk_tests) -> None:
    """The fleet panel: before a link, with one, each of its tabs, with a draft, under an emergency stop."""
    from fleet_supervisor.plugin.control.pending_command import CONE, Findings, PendingCommand

    dock, desk = desk_window.dock, desk_window.desk
    show.look("panel_alone", window)
    gateway.show(*(desk_tests.robot(f"r{k}", 50 + 8 * k, 40 + 6 * k, battery=0.1 * k) for k in range(1, 6)))
    dock.connection_panel._url.setText(gateway.url)
    dock.connection_panel._operator.setText("anna")
    desk_window.actions.connect.trigger()
    desk_tests.wait_until(lambda: len(desk.state.robots) == 5, what="five robots")
    desk_tests.wait_until(lambda: alarm_bar(window) is not None, what="the alarm of a low battery")
    desk.selection.select("r1")
    from tests.support.button_places import Watched

    make_panels_narrow(window)
    settle()
    show.watched = Watched(dock)
    order(desk, gateway, desk_tests)
    for tab in range(dock.tabs.count()):
        dock.tabs.setCurrentIndex(tab)
        show.look(f"panel_tab_{tab}", window)
    dock.tabs.setCurrentIndex(0)
    if window.canvas.width() < MAP_AT_LEAST:
        show.faults["map"] = [f"the fleet panel leaves {window.canvas.width()} pixels for the map"]
    found = Findings(overridable=("A cone target of r2 is 0.3 m from it",), warnings=("It is off the road",))
    desk.drafts.set_command(PendingCommand("r1", CONE, ((60.0, 50.0),), found))
    dock.connection_panel._more.setChecked(True)
    show.look("panel_with_draft_and_access", window)
    desk.drafts.done()
    dock.connection_panel._more.setChecked(False)
    gateway.stand(in_force=True, stop="s1", at=time.time(), by="anna", robots=5, waiting=["r1"])
    desk_tests.wait_until(lambda: not dock.banner.isHidden(), what="the banner")
    show.look("panel_emergency", window)
    crowd(gateway)
    desk_tests.wait_until(lambda: len(desk.state.conflicts.conflicts) == 4, 15, what="four conflicts")
    show.look("panel_crowded", window)
    count_rows(show, dock)
    gateway.tell("conflicts", {"t": time.time(), "conflicts": [], "waiting": []})
    desk_tests.wait_until(lambda: not desk.state.conflicts.conflicts, what="the end of the conflicts")
    gateway.stand(in_force=False)
    desk_tests.wait_until(lambda: dock.banner.isHidden(), what="the end of the banner")
    show.watched = None


def crowd(gateway) -> None:
    """Put more conflicts before the operator than are listed, with robots that wait."""
    now = time.time()
    times = {"begins": now + 5, "nearest_at": now + 7, "ends": now + 9}
    meeting = {"kind": "head-on", "metres": 0.4, "x": 60.0, "y": 50.0, **times}
    conflicts = [{**meeting, "robot": f"r{k}", "other": f"r{k + 1}"} for k in range(1, 5)]
    waiting = [
        {"robot": "r5", "other": "r1", "x": 50.0, "y": 40.0, "until": now + 30, "by": "eve", "command": "c9"}
    ]
    gateway.tell("conflicts", {"t": now, "conflicts": conflicts, "waiting": waiting})


def count_rows(show: Show, dock) -> None:
    """Take down when too few robots are seen, whatever else the panel has to say."""
    table, view = dock.table, dock.table.viewport()
    seen = view.visibleRegion().boundingRect()
    rows = range(table.model().rowCount())
    whole = [row for row in rows if seen.contains(table.visualRect(table.model().index(row, 0)))]
    if len(whole) < ROWS_AT_LEAST:
        show.faults["rows"] = [f"only {len(whole)} robots are seen beside a banner and conflicts"]


def alarm_bar(window) -> QWidget | None:
    return window.bar.findChild(QWidget, "fleet_alarm_bar")


def order(desk, gateway, desk_tests) -> None:
    """Put a command, a queue, observations and a conflict before the operator."""
    from fleet_supervisor.robot_bridge.core.messages.commands import CommandState

    gateway._queue("c1", "r1", "SetPosEnd", {"x": 60.0, "y": 50.0, "cone": True})
    gateway.step("c1", CommandState.DELIVERED, "r1")
    gateway.step("c1", CommandState.FAILED, "r1", reason="the way is blocked")
    task = {"robot": "r1", "kind": "place", "added_by": "anna", "added_at": time.time(), "x": 60.0, "y": 50.0}
    tasks = [{**task, "task": f"t{k}", "state": state} for k, state in enumerate(("current", "waiting"))]
    queue = {"robot": "r1", "revision": 1, "state": "paused", "robot_state": "fresh", "tasks": tasks}
    gateway.tell("queue", {**queue, "by": "bob", "at": time.time(), "reason": "paused by bob"})
    seen = {"robot": "r1", "op": "SetObject", "x": 20.0, "y": 30.0, "received_at": time.time()}
    for number, state in enumerate(("pending", "accepted"), 1):
        gateway.tell(
            "observation", {**seen, "observation": number, "object": f"bin-{number}", "state": state}
        )
    meeting = {"robot": "r1", "other": "r2", "kind": "head-on", "metres": 0.4, "x": 60.0, "y": 50.0}
    times = {"begins": time.time() + 5, "nearest_at": time.time() + 7, "ends": time.time() + 9}
    gateway.tell("conflicts", {"t": time.time(), "conflicts": [{**meeting, **times}], "waiting": []})
    desk_tests.wait_until(lambda: len(desk.state.observations) == 2, what="the observations")


def look_at_docks(show: Show, window, plugin, desk_tests) -> None:
    """The panels that the menu shows, one at a time as they are tabs of one another."""
    # With this large a font, a third panel and the bar of alarms side by side take a larger screen.
    window.findChild(QPushButton, "fleet_acknowledge_all").click()
    desk_tests.wait_until(lambda: alarm_bar(window) is None, what="the end of the bar of alarms")
    for part in plugin._parts:
        dock = getattr(part, "dock", None)
        if dock is not None and dock.objectName().startswith(tuple(f"fleet_{name}" for name in PANELS)):
            dock.setUserVisible(True)
            choose_first(dock)
            for tab, tabs in each_tab(dock):
                tabs.setCurrentIndex(tab)
                show.look(f"{dock.objectName()}_{tab}", window)
            show.look(dock.objectName(), window)
            dock.setUserVisible(False)


def choose_first(dock) -> None:
    """Have something chosen in a panel that shows what is chosen."""
    if hasattr(dock, "choose"):
        dock.reviewed.setChecked(True)
        settle()
        dock.choose(1)


def each_tab(widget: QWidget) -> Iterator[tuple[int, QWidget]]:
    from qgis.PyQt.QtWidgets import QTabWidget

    for tabs in widget.findChildren(QTabWidget):
        for tab in range(tabs.count()):
            yield tab, tabs


def look_at_options(show: Show, window) -> None:
    """The page of QGIS's options, in a frame like theirs."""
    frame = QDialog(window)
    page = window.options_pages[0].createWidget(frame)
    rows = QVBoxLayout(frame)
    rows.addWidget(page)
    rows.addWidget(QDialogButtonBox(QDialogButtonBox.StandardButton.Ok))
    frame.resize(OPTIONS_ROOM)
    frame.open()
    for tab, tabs in each_tab(page):
        tabs.setCurrentIndex(tab)
        show.look(f"options_{tab}", frame, OPTIONS_ROOM)
    frame.close()
    frame.deleteLater()


def look_at_tour(show: Show, window) -> None:
    """Each step of the tour, with all that may be said in it."""
    from fleet_supervisor.plugin.tour.tour_panel import STEPS, TourPanel

    panel = TourPanel(window)
    panel.set_practice(True)
    panel.show()
    for step in range(len(STEPS)):
        panel.show_step(step)
        panel.place(window.canvas)
        show.look(f"tour_{step}", panel)
    panel.deleteLater()


if __name__ == "__main__":
    main()
