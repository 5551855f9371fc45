"""Runs a demonstration inside QGIS and tells the process outside what happened."""

from __future__ import annotations

import faulthandler
import json
import os
import signal
import traceback
from collections.abc import Callable
from pathlib import Path

from qgis.core import Qgis, QgsApplication, QgsProject
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtTest import QTest
from qgis.utils import iface

from tests.support.inside_qgis.desk_view import NotHappenedError
from tests.support.inside_qgis.operator_at_desk import POLL_MS, OperatorAtDesk

PLAN_VARIABLE = "FLEET_DEMO_PLAN"


class Session:
    """The plan that came from outside, the operator, and the file that tells what happened."""

    def __init__(self) -> None:
        self.plan = json.loads(Path(os.environ[PLAN_VARIABLE]).read_text(encoding="utf-8"))
        self.operator = OperatorAtDesk(iface)
        self._journal = Path(self.plan["journal"])

    def happened(self, step: str, text: str, **figures: float) -> None:
        """Write down that ``step`` really happened."""
        self._write({"step": step, "text": text, "figures": figures})

    def failed(self, text: str) -> None:
        """Write down why the demonstration cannot go on."""
        self._write({"failed": text})

    def open_project(self) -> int:
        """Open the plan's project and return how many layers it has.

        :raises NotHappenedError: when it does not open, a layer is not valid, or QGIS complains about it.
        """
        if not iface.addProject(self.plan["project"]):
            raise NotHappenedError(f"QGIS could not open {self.plan['project']}")
        layers = QgsProject.instance().mapLayers().values()
        broken = [layer.name() for layer in layers if not layer.isValid()]
        if broken:
            raise NotHappenedError(f"layers of {self.plan['project']} are not valid: {', '.join(broken)}")
        self.operator.wait_for_map()
        complaint = iface.messageBar().currentItem()
        # On a slow machine it still says that it is loading, which is none.
        if complaint and complaint.level() in (Qgis.MessageLevel.Warning, Qgis.MessageLevel.Critical):
            raise NotHappenedError(f"QGIS complains about {self.plan['project']}: {complaint.text()}")
        return len(layers)

    def draw_only_what_is_seen(self) -> None:
        """Have no map of what lies beside the one that is shown drawn ahead: nobody drags it by hand."""
        for canvas in iface.mapCanvases():
            canvas.setPreviewJobsEnabled(False)

    def size_window(self, width: int, height: int) -> None:
        """Give the QGIS window this size in pixels."""
        window = iface.mainWindow()
        window.showNormal()
        window.move(0, 0)
        window.resize(width, height)

    def window(self):
        """Return the QGIS window."""
        return iface.mainWindow()

    def _write(self, entry: dict[str, object]) -> None:
        with self._journal.open("a", encoding="utf-8") as file:
            file.write(json.dumps(entry) + "\n")


def start(work: Callable[[Session], None]) -> None:
    """Do ``work`` as soon as the window is up; when it fails say so and end QGIS."""
    # Whoever waits for this program in vain asks by that signal where it is.
    faulthandler.register(signal.SIGUSR1, file=2)
    session = Session()

    def go() -> None:
        try:
            work(session)
        except NotHappenedError as error:
            session.failed(str(error))
            end()
        except Exception:
            session.failed(f"an error in the demonstration itself:\n{traceback.format_exc()}")
            end()

    QTimer.singleShot(0, go)


def end() -> None:
    """Close the project and leave QGIS by its own menu, as a user does: that takes the plugin out.

    Left by ``QgsApplication.exit`` it takes its window apart with the project open, and QGIS 3.44 crashes.
    With a project open, QGIS may ask about changes, or about layers that lie in the folder for temporary
    files, as those of a copy of this project may; about tasks that run it asks in any case. Nobody is there
    to answer.
    """
    while QgsApplication.taskManager().countActiveTasks():
        QTest.qWait(POLL_MS)
    iface.newProject(False)
    QgsProject.instance().setDirty(False)
    iface.actionExit().trigger()
