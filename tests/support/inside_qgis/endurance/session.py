"""`make bench PARTS=endurance` inside QGIS: an operator works, shift after shift, and the plugin is reloaded
between two shifts; memory, what is left behind and what goes wrong are written down."""

from __future__ import annotations

import gc
import sys
import threading
import time

import qgis.utils
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtGui import QPixmapCache
from qgis.PyQt.QtWidgets import QAction, QMenu, QTableView

from tests.support.inside_qgis.endurance.belongings import (
    PACKAGE,
    Belongings,
    belongings,
    left_over,
    running_threads,
)
from tests.support.inside_qgis.endurance.memory import megabytes, megabytes_in_use, megabytes_of_rasters
from tests.support.inside_qgis.endurance.play import Player, Script, Until
from tests.support.inside_qgis.endurance.pulse import Pulse
from tests.support.inside_qgis.endurance.shift import Shift
from tests.support.inside_qgis.endurance.trouble import Trouble
from tests.support.inside_qgis.session import Session, end, start

PANELS = ("fleet_plan_panel", "fleet_observations", "fleet_replay")
CONNECTION = "Endurance"
CONNECTS_WITHIN = 240.0
"""Seconds: longer than the longest waits between attempts and drops meanwhile, on a busy machine."""
LOOKS, LOOK_EVERY = 30, 2.0
"""How often at most, and every how many seconds, it looks whether all is gone that goes when there is time:
on a busy machine some of it was still there after two seconds, and gone later."""
SAMPLE_EVERY = 10.0


class Endurance:
    """The script, and what it watches."""

    def __init__(self, session: Session) -> None:
        self._session, self._plan = session, session.plan
        self._window, self._canvas = qgis.utils.iface.mainWindow(), qgis.utils.iface.mapCanvas()
        self._trouble = Trouble()
        self._pulse = Pulse()
        self._reloads = 0
        self._began = time.monotonic()
        self._timer = QTimer()
        self._timer.setInterval(round(SAMPLE_EVERY * 1000))
        self._timer.timeout.connect(self._sample)

    def script(self) -> Script:
        """Work shift after shift, with a fresh plugin each."""
        yield from self._unload()
        nothing = belongings(self._window, self._canvas)
        self._timer.start()
        shifts = self._plan["reloads"] + 1
        for number in range(shifts):
            self._load()
            yield 0.5
            yield from self._connect(first=number == 0)
            yield from self._open_panels()
            self._pulse.go_on()
            yield from self._work(number, self._began + self._plan["seconds"] * (number + 1) / shifts)
            yield self._connected()
            self._pulse.hold()
            yield from self._unload()
            yield from self._look_around(nothing)
        self._timer.stop()
        self._pulse.remove()
        self._trouble.remove()
        self._tell()

    def _load(self) -> None:
        if not (qgis.utils.loadPlugin(PACKAGE) and qgis.utils.startPlugin(PACKAGE)):
            raise RuntimeError(f"QGIS did not load {PACKAGE}")

    def _unload(self) -> Script:
        if not qgis.utils.unloadPlugin(PACKAGE):
            raise RuntimeError(f"QGIS did not unload {PACKAGE}")
        self._reloads += 1
        yield LOOK_EVERY

    def _connect(self, *, first: bool) -> Script:
        """Connect by the connection that QGIS keeps; the first time it is put there."""
        if first:
            self._keep_connection()
        menu = self._window.findChild(QMenu, "fleet_connections_menu")
        menu.aboutToShow.emit()
        menu.findChild(QAction, f"fleet_connection_{CONNECTION}").trigger()
        self._session.operator.press("fleet_connect")
        yield self._connected()

    def _open_panels(self) -> Script:
        """Show and hide each panel, however short the shift: they are made when they are shown first."""
        for name in PANELS:
            for _ in range(2):
                self._window.findChild(QAction, name).trigger()
                yield 0.1

    def _keep_connection(self) -> None:
        from fleet_supervisor.plugin.settings.profile import Connections, GatewayConnection

        kept = GatewayConnection(CONNECTION, self._plan["gateway"], self._plan["operator"])
        Connections().store(kept)

    def _connected(self) -> Until:
        wanted = len(self._plan["robots"])

        def holds() -> bool:
            return "Connected" in self._session.operator.link_state() and self._robots_listed() == wanted

        def found() -> str:
            return f"{self._session.operator.link_state()}, {self._robots_listed()} robots"

        return Until(f"a link with {wanted} robots", holds, CONNECTS_WITHIN, found)

    def _robots_listed(self) -> int:
        # Looked for each time: what is kept here would not go with the plugin.
        return self._window.findChild(QTableView, "fleet_robot_table").model().rowCount()

    def _work(self, number: int, until: float) -> Script:
        shift = Shift(self._session.operator, self._plan["robots"], number)
        while True:
            for act in shift.acts():
                for pause in act():
                    yield pause
                    if time.monotonic() >= until:
                        shift.put_away()
                        yield 0.5
                        return

    # --- what is watched ---

    def _sample(self) -> None:
        self._pulse.hold()
        gc.collect()
        all_of_it, files = megabytes()
        self._session.happened(
            "sample",
            "",
            at=time.monotonic() - self._began,
            megabytes=all_of_it,
            files=files,
            in_use=megabytes_in_use(),
            rasters=megabytes_of_rasters(),
            blocks=sys.getallocatedblocks(),
            reloads=self._reloads - 1,
            threads=running_threads(),
            python_threads=threading.active_count(),
            items=len(self._canvas.scene().items()),
            exceptions=self._trouble.exceptions.total(),
        )
        if qgis.utils.isPluginLoaded(PACKAGE):
            self._pulse.go_on()

    def _look_around(self, nothing: Belongings) -> Script:
        for _ in range(LOOKS):
            left = belongings(self._window, self._canvas)
            more = left_over(nothing, left)
            if not more:
                break
            yield LOOK_EVERY
        # Pictures take tens of megabytes: of a map that is being drawn, of its layers, and in Qt's cache that
        # grows by 0.4 MB with each loading until it has 10 MB.
        yield Until("a drawn map", lambda: not self._canvas.isDrawing(), CONNECTS_WITHIN, lambda: "none")
        self._canvas.clearCache()
        QPixmapCache.clear()
        text = f"unloaded for the {self._reloads - 1}th time; left: {'; '.join(more) or 'nothing'}"
        self._session.happened(
            "unloaded",
            text,
            left=more,
            megabytes=megabytes_in_use(),
            rasters=megabytes_of_rasters(),
            blocks=sys.getallocatedblocks(),
        )

    def _tell(self) -> None:
        pulse, trouble = self._pulse, self._trouble
        self._session.happened(
            "end",
            "the last shift is over",
            exceptions=trouble.exceptions,
            warnings=trouble.warnings,
            told=trouble.told,
            seconds=pulse.seconds,
            longer={str(step): number for step, number in pulse.longer.items()},
            work_at=pulse.work_at,
            gaps_at=pulse.gaps_at,
            worst=[vars(gap) for gap in pulse.worst()],
        )


def work(session: Session) -> None:
    """Open the project and begin."""
    session.size_window(*session.plan["window"])
    session.open_project()
    session.operator.show_map(session.plan["extent"], session.plan["crs"])
    endurance = Endurance(session)

    def done(error: Exception | None) -> None:
        if error is not None:
            session.failed(_in_words(error))
        end()

    Player(endurance.script(), done).begin()


def _in_words(error: Exception) -> str:
    import traceback

    return "".join(traceback.format_exception(error))


start(work)
