"""Writes down what goes wrong in QGIS, wherever it comes up."""

from __future__ import annotations

import sys
import threading
import traceback
from collections import Counter
from types import TracebackType

from qgis.core import Qgis, QgsApplication

SAID_BY_THE_PLUGIN = "Fleet Supervisor"
"""The tag of what the plugin tells the operator in QGIS's log: lost links and alarms are no faults of it."""


class Trouble:
    """Hears of every exception that nobody caught and of all that QGIS logs, until :meth:`remove`."""

    def __init__(self) -> None:
        self.exceptions: Counter[str] = Counter()
        """Each by its traceback."""
        self.warnings: Counter[str] = Counter()
        """What QGIS logged as a warning or worse, but for what the plugin told the operator."""
        self.told: Counter[str] = Counter()
        """What the plugin told the operator, by level."""
        self._hooks = sys.excepthook, threading.excepthook, sys.unraisablehook
        sys.excepthook = self._raised
        threading.excepthook = self._raised_in_thread
        sys.unraisablehook = self._raised_for_nobody
        self._log = QgsApplication.messageLog()
        self._log.messageReceived.connect(self._logged)

    def remove(self) -> None:
        """Hear no more."""
        sys.excepthook, threading.excepthook, sys.unraisablehook = self._hooks
        self._log.messageReceived.disconnect(self._logged)

    def _raised(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        self.exceptions["".join(traceback.format_exception(kind, error, trace))] += 1
        self._hooks[0](kind, error, trace)

    def _raised_in_thread(self, what: threading.ExceptHookArgs) -> None:
        text = "".join(traceback.format_exception(what.exc_type, what.exc_value, what.exc_traceback))
        self.exceptions[f"in thread {what.thread.name if what.thread else '?'}: {text}"] += 1
        self._hooks[1](what)

    def _raised_for_nobody(self, what: sys.UnraisableHookArgs) -> None:
        text = "".join(traceback.format_exception(what.exc_type, what.exc_value, what.exc_traceback))
        self.exceptions[f"{what.err_msg or 'ignored'} {what.object!r}: {text}"] += 1
        self._hooks[2](what)

    def _logged(self, text: str, tag: str, level: Qgis.MessageLevel) -> None:
        if tag == SAID_BY_THE_PLUGIN:
            self.told[_word(level)] += 1
        elif level in (Qgis.MessageLevel.Warning, Qgis.MessageLevel.Critical):
            self.warnings[f"{tag}: {text}"] += 1


def _word(level: Qgis.MessageLevel) -> str:
    words = {Qgis.MessageLevel.Critical: "critical", Qgis.MessageLevel.Warning: "warning"}
    return words.get(level, "info")
