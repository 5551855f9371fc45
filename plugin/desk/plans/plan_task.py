"""Makes a plan beside the window's thread, with progress and cancel."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable

from qgis.core import QgsTask
from qgis.PyQt.QtCore import pyqtSignal

from ....robot_bridge.assignment.errors import AssignmentError, CancelledError
from ....robot_bridge.roads.errors import RoadsError
from ...errors import FleetError
from ...language import tr
from .draft import Draft


class PlanTask(QgsTask):
    """Does ``work``, which is given the task.

    Unless cancelled, ``made`` or ``refused`` is emitted in the window's thread.
    """

    made = pyqtSignal(object)
    refused = pyqtSignal(str)

    def __init__(self, title: str, work: Callable[[PlanTask], Draft]):
        super().__init__(title, QgsTask.Flag.CanCancel)
        self._work = work
        self._draft: Draft | None = None
        self._why = ""
        self.share = 0.0
        """How much is done, 0 to 1; known when QGIS has deleted the task, too."""
        self.left = threading.Event()
        """Set once the worker has left :meth:`run`."""

    def run(self) -> bool:
        try:
            self._draft = self._work(self)
        except CancelledError:
            pass
        except (AssignmentError, RoadsError, FleetError) as error:
            self._why = str(error)
        except Exception:
            self._why = tr(
                "The plan could not be made. Please report this:\n{traceback}",
                traceback=traceback.format_exc(),
            )
        finally:
            self.left.set()
        return self._draft is not None

    def finished(self, done: bool) -> None:
        if self.isCanceled():
            return
        if self._draft is not None:
            self.made.emit(self._draft)
        else:
            self.refused.emit(self._why)

    def told(self, share: float) -> bool:
        """Show that ``share`` of the work, 0 to 1, is done; return whether to go on."""
        self.share = share
        self.setProgress(100.0 * share)
        return self.goes_on()

    def goes_on(self) -> bool:
        """Whether nobody has cancelled it."""
        return not self.isCanceled()
