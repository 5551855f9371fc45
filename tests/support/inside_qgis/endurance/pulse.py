"""Feels the pulse of QGIS's window: how long it is busy at a stretch, and with what."""

from __future__ import annotations

import gc
import sys
import threading
import time
from collections import Counter
from dataclasses import dataclass
from types import FrameType

from qgis.PyQt.QtCore import Qt, QTimer

from tests.support.inside_qgis.endurance.belongings import PACKAGE

BEAT_MS = 5
LATE = 0.010
"""Seconds without a beat from which on somebody looks what the window is busy with."""
LOOK_EVERY = 0.004
WORST = 40
STEPS = (0.010, 0.020, 0.050, 0.100, 0.250)
"""Seconds: gaps are counted that are longer."""


@dataclass(frozen=True)
class Gap:
    """The window did nothing else for ``seconds``, of which its thread worked ``worked``; ``busy_with`` says
    where it was seen most of the time: what Qt called in the plugin, and the innermost place there."""

    seconds: float
    worked: float
    busy_with: str


class Pulse:
    """Beats in the window's thread; :meth:`remove` ends it. What is done between :meth:`hold` and
    :meth:`go_on` does not count."""

    def __init__(self) -> None:
        self.gaps: list[Gap] = []
        """The longest ones by the work in them, the worst first."""
        self.longer: Counter[float] = Counter()
        """How many gaps had more work than each of STEPS, in seconds."""
        self.work_at: Counter[str] = Counter()
        """Seconds of work in all gaps with more than LATE, by what the window was busy with."""
        self.gaps_at: Counter[str] = Counter()
        self.seconds = 0.0
        """How long it has felt."""
        self._window = threading.get_ident()
        self._seen: Counter[str] = Counter()
        self._beat = self._worked = 0.0
        self._holding = True
        self._ended = False
        self._timer = QTimer()
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(BEAT_MS)
        self._timer.timeout.connect(self._felt)
        gc.callbacks.append(self._collecting)
        self._collected = False
        self._looker = threading.Thread(target=self._look, name="pulse", daemon=True)
        self._looker.start()

    def hold(self) -> None:
        """Feel nothing for a while."""
        self._holding = True
        self._timer.stop()

    def go_on(self) -> None:
        """Feel again."""
        self._seen.clear()
        self._beat, self._worked = time.perf_counter(), time.thread_time()
        self._holding = False
        self._timer.start()

    def remove(self) -> None:
        """Feel no more."""
        self.hold()
        self._ended = True
        gc.callbacks.remove(self._collecting)
        self._looker.join()

    def _felt(self) -> None:
        now, worked = time.perf_counter(), time.thread_time()
        gap, work = now - self._beat, worked - self._worked
        self._beat, self._worked = now, worked
        self.seconds += gap
        if work > LATE:
            self._note(gap, work)
        self._seen.clear()
        self._collected = False

    def _note(self, gap: float, work: float) -> None:
        busy_with = self._seen.most_common(1)[0][0] if self._seen else "QGIS"
        if self._collected:
            busy_with = "Python's garbage collection"
        for step in STEPS:
            self.longer[step] += work > step
        self.work_at[busy_with] += work
        self.gaps_at[busy_with] += 1
        self.gaps.append(Gap(gap, work, busy_with))
        if len(self.gaps) > 2 * WORST:
            self._keep_worst()

    def _keep_worst(self) -> None:
        self.gaps.sort(key=lambda gap: -gap.worked)
        del self.gaps[WORST:]

    def worst(self) -> list[Gap]:
        """Return the longest gaps, the longest first."""
        self._keep_worst()
        return list(self.gaps)

    def _collecting(self, phase: str, info: dict[str, int]) -> None:
        # While it holds, it is the script that collects.
        of_window = not self._holding and threading.get_ident() == self._window
        if phase == "start" and info["generation"] == 2 and of_window:
            self._collected = True

    def _look(self) -> None:
        while not self._ended:
            time.sleep(LOOK_EVERY)
            if self._holding or time.perf_counter() - self._beat < LATE:
                continue
            # No name for the frame: it would live on, and with it all that it knows of the plugin.
            self._seen[_where(sys._current_frames().get(self._window))] += 1


def _where(frame: FrameType | None) -> str:
    """Return what Qt called in the plugin, and the innermost place in it, else who else was at work."""
    ours, is_script = [], False
    while frame is not None:
        module = frame.f_globals.get("__name__", "")
        is_script = is_script or module.startswith("inside_qgis.")
        if module.startswith(f"{PACKAGE}."):
            ours.append(f"{module.removeprefix(f'{PACKAGE}.plugin.')}.{frame.f_code.co_name}")
        frame = frame.f_back
    if not ours:
        return "the operator's script" if is_script else "QGIS"
    return ours[0] if len(ours) == 1 else f"{ours[-1]} › {ours[0]}"
