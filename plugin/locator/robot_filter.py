"""Robots in QGIS's locator: ``rb name`` goes there and selects."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from qgis.core import QgsFeedback, QgsLocatorContext, QgsLocatorFilter, QgsLocatorResult
from qgis.PyQt.QtGui import QIcon

from ...robot_bridge.messages import RobotState
from ..desk.state_words import ROBOT_STATES
from ..expressions.robots_now import FleetNow, RobotsNow
from ..language import tr

NAME = "fleet_robots"
MOST = 50
"""Results: nobody reads more, and the list is made anew with each letter."""


@dataclass
class LastSearch:
    """What was looked for last, for the filter and its clones, which are gone when a result is chosen."""

    text: str = ""


class RobotFilter(QgsLocatorFilter):
    """Finds robots by any part of their name; ``go`` is called with the one that was chosen.

    ``typed`` returns what stands in the locator's field, None where there is none.

    QGIS looks with a clone of the filter, in the window's thread: it is fast. In a thread of its own it could
    wait for Python for ever, where the plugin is unloaded meanwhile and QGIS waits for that thread.
    """

    def __init__(
        self,
        fleet: FleetNow,
        icons: Mapping[str, QIcon],
        go: Callable[[str], None],
        typed: Callable[[], str | None],
        last: LastSearch | None = None,
    ):
        super().__init__()
        self._fleet, self._icons, self._go, self._typed = fleet, icons, go, typed
        self._robots: RobotsNow | None = None
        self._last = last or LastSearch()

    def clone(self):
        return RobotFilter(self._fleet, self._icons, self._go, self._typed, self._last)

    def name(self):
        return NAME

    def displayName(self):
        return tr("Robots")

    def flags(self):
        return QgsLocatorFilter.Flag.FlagFast

    def prefix(self):
        # Shorter ones of plugins are passed over, unless the user has chosen them: see RobotLocator.
        return "robot"

    def priority(self):
        return QgsLocatorFilter.Priority.High

    def prepare(self, _string: str, _context: QgsLocatorContext):
        self._robots = self._fleet.robots
        return []

    def fetchResults(self, string: str, context: QgsLocatorContext, feedback: QgsFeedback):
        self._last.text = string.strip()
        robots = self._robots
        if robots is None or (not string.strip() and not context.usingPrefix):
            return
        for score, name in ranked(string, list(robots.rows))[:MOST]:
            if feedback.isCanceled():
                return
            self.resultFetched.emit(self._result(name, robots, score))

    def triggerResult(self, result: QgsLocatorResult):
        # QGIS looks a moment after the last letter. Whoever presses Enter sooner is given a row of what was
        # typed before, which may be another robot: what is typed counts.
        typed = self._typed_name()
        if typed is None:
            self._go(result.displayString)
            return
        robots = self._fleet.robots
        names = [name for _, name in ranked(typed, list(robots.rows))] if robots is not None else []
        if typed == self._last.text and result.displayString in names:
            self._go(result.displayString)
        elif names:
            self._go(names[0])

    def _typed_name(self) -> str | None:
        """Return what stands in the locator's field behind the prefix."""
        text = self._typed()
        if text is None:
            return None
        prefix, space, name = text.partition(" ")
        behind = name if space and prefix.casefold() == self.activePrefix().casefold() else text
        return behind.strip()

    def _result(self, name: str, robots: RobotsNow, score: float) -> QgsLocatorResult:
        state, age = robots.state(name), robots.silence(name)
        told = ROBOT_STATES[RobotState(state)]
        result = QgsLocatorResult()
        result.displayString = name
        result.description = (
            told if age is None else tr("{state}, heard of {age:.0f} s ago", state=told, age=age)
        )
        result.score = score
        if state in self._icons:
            result.icon = self._icons[state]
        return result


def ranked(wanted: str, names: list[str]) -> list[tuple[float, str]]:
    """Return the names that ``wanted`` is a part of, each with a score from 0 to 1, the best first.

    A name that is the same comes before one that begins so, and that before one that has it within.
    """
    wanted = wanted.strip().casefold()
    found = []
    for name in names:
        at = name.casefold().find(wanted)
        if at >= 0:
            same = len(name) == len(wanted)
            found.append((1.0 if same else 0.9 if at == 0 else 0.6, name))
    return sorted(found, key=lambda one: (-one[0], len(one[1]), one[1]))
