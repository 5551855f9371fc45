"""A QGIS window with what a desk needs of it, and a small gateway on a real socket."""

from __future__ import annotations

import asyncio
import gc
import itertools
import json
import sys
import threading
import time
import traceback
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import replace

import pytest
from fleet_supervisor.robot_bridge.core.messages.administration import SiteReport
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from fleet_supervisor.robot_bridge.core.messages.positions import RobotReport
from fleet_supervisor.robot_bridge.core.messages.safety import EmergencyReport, RobotState
from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsFeature,
    QgsGeometry,
    QgsLocator,
    QgsProject,
    QgsRectangle,
    QgsSettings,
    QgsVectorFileWriter,
    QgsVectorLayer,
)
from qgis.gui import QgsGui, QgsMapCanvas, QgsMapToolPan, QgsMessageBar
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QCoreApplication, QEvent, QPoint, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QApplication, QLabel, QMainWindow, QWidget
from websockets.asyncio.server import serve
from websockets.exceptions import ConnectionClosed

from tests.support.inside_qgis.mouse import move_mouse
from tests.support.patience import BUSY, START

ORIGIN = (488000.0, 5190000.0)
TOUR_OFFERED = "tour_offered"
BAR_SIZE = (600, 40)
"""Pixels: the bar lies in no layout, and an item of QGIS 3.44 takes no more room than its bar has."""


@pytest.fixture(scope="session", autouse=True)
def nothing_outlives_qgis(qgis_app):
    """Collect what lies about while QGIS is there: what is collected after it takes Python with it."""
    yield
    gc.collect()


@pytest.fixture(scope="session", autouse=True)
def no_stall_counts_as_sleep():
    """Have no desk refuse requests, or renew its link, because a busy machine stood still for seconds.

    Tests of that let hours pass.
    """
    from fleet_supervisor.plugin.gateway_client import connection, fleet_state

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(fleet_state, "STANDSTILL_S", START)
        patched.setattr(connection, "ASLEEP_AFTER", START)
        yield


@pytest.fixture(autouse=True)
def nothing_raised_unseen():
    """Have a test fail where a slot raises: PyQt ends the program, or QGIS's hook hides it.

    Which of the two depends on whether an earlier test has imported ``qgis.utils``.
    """
    raised, before = [], sys.excepthook

    def note(kind, error, trace):
        raised.append("".join(traceback.format_exception(kind, error, trace)))

    sys.excepthook = note
    yield
    sys.excepthook = before
    assert not raised, "\n".join(raised)


@pytest.fixture
def site() -> SiteReport:
    return SiteReport(
        id="yard",
        name="Yard",
        version="1",
        crs="EPSG:32633",
        origin=ORIGIN,
        rotation=0.0,
        bounds=(0.0, 0.0, 200.0, 160.0),
        reached_tolerance=0.2,
        # Robots report once here: they are fresh however long a slow machine takes.
        stale_after=3600.0,
        lost_after=7200.0,
    )


def robot(name="r1", x=50.0, y=40.0, theta=0.0, **more) -> RobotReport:
    values = {"state": RobotState.FRESH, "age": 0.0, "link": "websocket", "v": 0.5, "battery": 0.8}
    return RobotReport(robot=name, x=x, y=y, theta=theta, **{**values, **more})


@pytest.fixture
def make_robot():
    return robot


class SmallGateway:
    """Speaks the desk's wire over a real socket, from a thread of its own."""

    def __init__(self, site: SiteReport):
        self.site = site
        self.port = 0
        self.protocol = 1
        self.database = ""
        """What it tells a desk of its database; nothing where it is empty, as older gateways do."""
        self.who: dict[str, str] = {}
        """What it tells a desk of who that is: ``operator`` and ``role``, as gateways with accounts do."""
        self.robots: dict[str, RobotReport] = {}
        self.commands: dict[str, CommandReport] = {}
        self.requests: list[tuple[str, dict]] = []
        self.refuse: dict[str, str] = {}
        self.emergency = EmergencyReport()
        self.mute: set[str] = set()
        """Methods that are taken in and never answered."""
        self.raw: str | bytes | None = None
        """What is sent in place of every answer."""
        self.answers: dict[str, Callable[[dict], dict]] = {}
        """By method, what answers it in place of what is here: returns {"result": …} or {"error": …}."""
        self.subscriptions = 0
        """How many desks have begun to be told of what happens."""
        self._sockets: set = set()
        self._clock = itertools.count(1_700_000_000)

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self.port}/desk"

    def start(self) -> None:
        self._loop = asyncio.new_event_loop()
        ready = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(ready,), daemon=True)
        self._thread.start()
        assert ready.wait(START)

    def stop(self) -> None:
        """Vanish as a killed process does: sockets reset, nothing said."""
        if not self._loop.is_running():
            return
        self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(START)

    def requests_of(self, method: str) -> list[dict]:
        return [params for name, params in self.requests if name == method]

    def show(self, *robots: RobotReport) -> None:
        self.robots.update({robot.robot: robot for robot in robots})
        self.tell("positions", {"t": time.time(), "robots": [to_json(robot) for robot in robots]})

    def step(self, command: str, state: CommandState, by: str, **more) -> None:
        known = self.commands[command]
        steps = [*known.steps, CommandStep(state, float(next(self._clock)), by, more.pop("reason", None))]
        values = {**vars(known), "state": state, "steps": steps, **more}
        self.commands[command] = CommandReport(**values)
        self.tell("command", to_json(self.commands[command]))

    def stand(self, **how) -> None:
        """Tell how an emergency stop stands."""
        self.emergency = replace(self.emergency, **how)
        self.tell("emergency", to_json(self.emergency))

    def tell(self, method: str, params: dict) -> None:
        """Send every desk a notification."""
        text = json.dumps({"jsonrpc": "2.0", "method": method, "params": params})
        for socket in list(self._sockets):
            asyncio.run_coroutine_threadsafe(socket.send(text), self._loop).result(START)

    def _run(self, ready: threading.Event) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._serve(ready))
        self._loop.close()

    async def _serve(self, ready: threading.Event) -> None:
        self._stop = asyncio.Event()
        async with serve(self._desk, "127.0.0.1", self.port, close_timeout=0.05) as server:
            self.port = server.sockets[0].getsockname()[1]
            ready.set()
            await self._stop.wait()
            for socket in list(self._sockets):
                socket.transport.abort()
        self._sockets.clear()

    async def _desk(self, socket) -> None:
        if socket.request.path != "/desk":
            await socket.close(1008, "no desk here")
            return
        try:
            async for text in socket:
                message = json.loads(text)
                self.requests.append((message["method"], message["params"]))
                if message["method"] in self.mute:
                    continue
                await socket.send(self.raw or json.dumps(self._answer(message)))
                if message["method"] == "subscribe":
                    self._sockets.add(socket)
                    self.subscriptions += 1
                    robots = [to_json(robot) for robot in self.robots.values()]
                    params = {"t": time.time(), "robots": robots}
                    await socket.send(json.dumps({"jsonrpc": "2.0", "method": "positions", "params": params}))
        except ConnectionClosed:
            pass
        finally:
            self._sockets.discard(socket)

    def _answer(self, message: dict) -> dict:
        method, params = message["method"], message["params"]
        answer = {"jsonrpc": "2.0", "id": message["id"]}
        if method in self.refuse:
            return {**answer, "error": {"code": -32000, "message": self.refuse[method]}}
        if method in self.answers:
            return {**answer, **self.answers[method](params)}
        if method == "hello":
            facts = {"site": to_json(self.site), "emergency": to_json(self.emergency)}
            facts |= {"database": self.database} if self.database else {}
            return {**answer, "result": {"protocol": self.protocol, **facts, **self.who}}
        if method == "send":
            return {**answer, "result": to_json(self._queue(**params))}
        if method in ("emergency_stop", "clear_emergency_stop"):
            return {**answer, "result": to_json(self._stop_or_clear(method, params))}
        if method == "abort_all":
            queued = [self._queue(f"abort-{name}", name, "Abort") for name in self.robots]
            return {**answer, "result": {"commands": [to_json(command) for command in queued]}}
        if method == "get_commands":
            newest_first = list(reversed(self.commands.values()))
            return {**answer, "result": {"commands": [to_json(command) for command in newest_first]}}
        return {**answer, "result": {}}

    def _stop_or_clear(self, method: str, params: dict) -> EmergencyReport:
        if method == "clear_emergency_stop":
            self.emergency = replace(self.emergency, in_force=False)
        elif self.emergency.stop != params["command"]:
            robots = sorted(self.robots)
            self.emergency = EmergencyReport(
                True, params["command"], 1_700_000_000.0, "anna", robots=len(robots), waiting=robots
            )
        return self.emergency

    def _queue(self, command: str, robot: str, op: str, params: dict | None = None) -> CommandReport:
        if command not in self.commands:
            steps = [CommandStep(CommandState.QUEUED, float(next(self._clock)), "anna")]
            self.commands[command] = CommandReport(
                command, robot, op, params or {}, "anna", CommandState.QUEUED, steps
            )
        return self.commands[command]


@pytest.fixture
def gateway(site):
    small = SmallGateway(site)
    small.start()
    yield small
    small.stop()


def wait_until(true, seconds: float = 5.0, what: str = "the condition") -> None:
    """Let Qt work until ``true()`` holds; ``seconds`` are an idle machine's."""
    begin = time.monotonic()
    while not true():
        waited = time.monotonic() - begin
        assert waited < BUSY * seconds, f"{what} did not come within {BUSY * seconds:g} s"
        # What does not come at once is looked for less often: to look for it may take longer than Qt's work.
        QTest.qWait(10 if waited < 0.1 else 30)


@pytest.fixture
def wait():
    return wait_until


class Window(QMainWindow):
    """The parts of QgisInterface that the desk uses, each a real one."""

    def __init__(self):
        super().__init__()
        self.canvas = QgsMapCanvas()
        self.canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
        self.setCentralWidget(self.canvas)
        self.bar = QgsMessageBar(self.canvas)
        self.bar.resize(*BAR_SIZE)
        self.plugins = self.menuBar().addMenu("Plugins")
        self.plugin_help = self.menuBar().addMenu("Help").addMenu("Plugins")
        self.locator = QgsLocator(self)
        self.options_pages = []
        self.drop_handlers = []
        self.exit_blockers = []
        self.is_settled = lambda: True
        """Whether what a click begins has come to its end."""
        self._pan_tool = QgsMapToolPan(self.canvas)
        self._pan = QAction("Pan", self)
        self._pan.triggered.connect(lambda: self.canvas.setMapTool(self._pan_tool))
        self._pan.trigger()

    def mapCanvas(self):
        return self.canvas

    def messageBar(self):
        return self.bar

    def mainWindow(self):
        return self

    def actionPan(self):
        return self._pan

    def addToolBar(self, name):
        return super().addToolBar(name)

    def removeDockWidget(self, dock):
        super().removeDockWidget(dock)

    def addPluginToMenu(self, menu, action):
        self.plugins.addAction(action)

    def removePluginMenu(self, menu, action):
        self.plugins.removeAction(action)

    def pluginHelpMenu(self):
        return self.plugin_help

    def registerLocatorFilter(self, one):
        self.locator.registerFilter(one)

    def deregisterLocatorFilter(self, one):
        self.locator.deregisterFilter(one)

    def registerOptionsWidgetFactory(self, factory):
        self.options_pages.append(factory)

    def unregisterOptionsWidgetFactory(self, factory):
        self.options_pages.remove(factory)

    def registerCustomDropHandler(self, handler):
        self.drop_handlers.append(handler)

    def unregisterCustomDropHandler(self, handler):
        self.drop_handlers.remove(handler)

    def registerApplicationExitBlocker(self, blocker):
        self.exit_blockers.append(blocker)

    def unregisterApplicationExitBlocker(self, blocker):
        self.exit_blockers.remove(blocker)

    def closeEvent(self, event):
        # As QGIS does, however it is left.
        event.setAccepted(all(blocker.allowExit() for blocker in self.exit_blockers))

    def texts(self) -> list[str]:
        """What hangs in the message bar."""
        return [label.text() for label in self.bar.findChildren(QLabel, "fleet_notice")]

    def look_at(self, x_min, y_min, x_max, y_max) -> None:
        """Show a part of the site, in metres from its origin, when it is not rotated."""
        self.canvas.setExtent(
            QgsRectangle(ORIGIN[0] + x_min, ORIGIN[1] + y_min, ORIGIN[0] + x_max, ORIGIN[1] + y_max)
        )

    def pixel(self, x, y) -> QPoint:
        """Return where on the canvas the site's (x, y) is, when it is not rotated and in EPSG:32633."""
        at = self.canvas.getCoordinateTransform().transform(ORIGIN[0] + x, ORIGIN[1] + y)
        return QPoint(round(at.x()), round(at.y()))

    def hover(self, x, y) -> None:
        """Move the mouse to there over the map."""
        move_mouse(self.canvas.viewport(), self.pixel(x, y))

    def click(self, x, y, button=Qt.MouseButton.LeftButton) -> None:
        QTest.mouseClick(self.canvas.viewport(), button, Qt.KeyboardModifier.NoModifier, self.pixel(x, y))
        wait_until(self.is_settled, what="the check of the draft")


@pytest.fixture
def iface(qgis_app):
    forget_settings()
    QgsProject.instance().clear()
    # Tests press faster than any hand; what a double click does has a test that sets it.
    QApplication.setDoubleClickInterval(1)
    window = Window()
    window.resize(1280, 800)
    window.show()
    window.activateWindow()
    # Before that, a canvas may still be given its size.
    assert QTest.qWaitForWindowExposed(window, 20_000)
    QApplication.processEvents()
    window.look_at(0, 0, 120, 100)
    yield window
    window.canvas.stopRendering()
    QgsProject.instance().clear()
    forget_settings()
    if not sip.isdeleted(window):
        # QGIS's list of shortcuts does not notice that an action is deleted.
        for action in window.findChildren(QAction):
            QgsGui.shortcutsManager().unregisterAction(action)
        window.close()
        window.deleteLater()
    let_deleted_go()


def forget_settings() -> None:
    """Leave of what a test kept in QGIS's settings that the tour was offered: it is once in a profile.

    Each change is written to the disk.
    """
    settings = QgsSettings()
    settings.beginGroup("fleet_supervisor")
    if settings.allKeys() != [TOUR_OFFERED]:
        settings.remove("")
        settings.setValue(TOUR_OFFERED, True)


@contextmanager
def unpainted(window: QWidget):
    """Have nothing of ``window`` painted meanwhile: what is set up or taken down nobody looks at."""
    window.setUpdatesEnabled(False)
    yield
    window.setUpdatesEnabled(True)


def let_deleted_go() -> None:
    """Delete what asked to be deleted later."""
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


@pytest.fixture(scope="module")
def registered_provider(qgis_app):
    """The provider of algorithms, for all windows of a module: to make it takes a sixth of a plugin's start.

    A plugin that is loaded beside it uses it, as where two copies of the plugin are loaded.
    """
    from fleet_supervisor.plugin.plugin import FleetProvider

    made = FleetProvider()
    registry = QgsApplication.processingRegistry()
    assert registry.addProvider(made)
    yield made
    assert registry.removeProvider(made)


@pytest.fixture
def plugin(iface, registered_provider):
    from fleet_supervisor.plugin.plugin import FleetPlugin

    loaded = FleetPlugin(iface)
    loaded.initGui()
    yield loaded
    with unpainted(iface):
        loaded.unload()
        let_deleted_go()


@pytest.fixture
def at_desk(plugin, gateway, iface):
    """The plugin connected to the small gateway with two robots on the map."""
    gateway.show(robot("r1", 50, 40), robot("r2", 80, 60, theta=1.5))
    window = plugin.window
    window.dock.connection_panel._url.setText(gateway.url)
    window.dock.connection_panel._operator.setText("anna")
    with unpainted(iface):
        window.actions.connect.trigger()
        wait_until(lambda: len(window.desk.state.robots) == 2, what="two robots")
        # What is known is shown in a piece of its own.
        wait_until(lambda: window.dock.table.model().rowCount() == 2, what="two robots in the table")
    iface.is_settled = lambda: not window.desk.checks.is_under_way
    return window


# --- layers in memory ---

HEIGHT = "&field=height:double"


def memory_layer(name="walls", kind="LineString", fields=HEIGHT, features=(), crs="EPSG:32633"):
    """Return a layer; each of ``features`` is (WKT or QgsGeometry or None, *values)."""
    layer = QgsVectorLayer(f"{kind}?crs={crs}{fields}", name, "memory")
    assert layer.isValid()
    made = []
    for shape, *values in features:
        feature = QgsFeature(layer.fields())
        if shape is not None:
            feature.setGeometry(QgsGeometry.fromWkt(shape) if isinstance(shape, str) else shape)
        feature.setAttributes(list(values))
        made.append(feature)
    ok, added = layer.dataProvider().addFeatures(made)
    assert ok and len(added) == len(made)
    layer.updateExtents()
    return layer


@pytest.fixture
def make_layer(qgis_app):
    """Make a layer in memory of what QGIS calls it: a type, fields, and WKT with values."""
    return memory_layer


DRIVERS = {".fgb": "FlatGeobuf", ".geojson": "GeoJSON", ".gpkg": "GPKG", ".shp": "ESRI Shapefile"}


@pytest.fixture
def save_layer(tmp_path):
    """Write a layer into a file, and open that: ``save_layer(layer, "walls.gpkg")``."""

    def save(layer: QgsVectorLayer, name: str) -> QgsVectorLayer:
        file = tmp_path / name
        options = QgsVectorFileWriter.SaveVectorOptions()
        options.driverName = DRIVERS[file.suffix]
        options.layerName = file.stem
        transforms = QgsCoordinateTransformContext()
        failed = QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(file), transforms, options)
        assert not failed[0], failed
        made = QgsVectorLayer(str(file), layer.name(), "ogr")
        assert made.isValid()
        return made

    return save
