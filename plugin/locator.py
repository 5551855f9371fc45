"""Robots in QGIS's locator bar: the filter ``rb name``, and its registration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from qgis.core import Qgis, QgsFeedback, QgsLocatorContext, QgsLocatorFilter, QgsLocatorResult, QgsSettings
from qgis.gui import QgisInterface, QgsLocatorWidget
from qgis.PyQt.QtWidgets import QLineEdit

from ..robot_bridge.core.messages.safety import RobotState
from .expressions import RobotSnapshot, SnapshotHolder
from .gateway_client.state_words import ROBOT_STATES
from .ui.glyphs import StateIcons
from .ui.language import tr

NAME = "fleet_robots"
MOST = 50
"""Results: nobody reads more, and the list is made again with each letter."""


@dataclass
class LastSearch:
    """What was looked for last, for the filter and its clones, which are gone when a result is chosen."""

    text: str = ""

    def note(self, text: str) -> None:
        """Keep what was searched for."""
        self.text = text


class RobotViewer(Protocol):
    """Who shows a robot: the window."""

    def go_to(self, robot: str) -> None:
        """Select a robot alone and show where it is."""


class LocatorField(Protocol):
    """Who knows the locator's field."""

    def typed(self) -> str | None:
        """Return what stands in the field, None where there is none."""


class RobotFilter(QgsLocatorFilter):
    """Finds robots by any part of their name, and has ``viewer`` show the one that was chosen.

    ``field`` knows what stands in the locator's field.

    QGIS looks with a clone of the filter, in the window's thread: it is fast. In a thread of its own it could
    wait for Python for ever, where the plugin is unloaded meanwhile and QGIS waits for that thread.
    """

    def __init__(
        self,
        fleet: SnapshotHolder,
        icons: StateIcons,
        viewer: RobotViewer,
        field: LocatorField,
        last: LastSearch | None = None,
    ):
        super().__init__()
        self._fleet, self._icons, self._viewer, self._field = fleet, icons, viewer, field
        self._robots: RobotSnapshot | None = None
        self._last = last or LastSearch()

    def clone(self):
        return RobotFilter(self._fleet, self._icons, self._viewer, self._field, self._last)

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
        self._last.note(string.strip())
        robots = self._robots
        if robots is None or (not string.strip() and not context.usingPrefix):
            return
        for score, name in rank_robots(string, list(robots.rows))[:MOST]:
            if feedback.isCanceled():
                return
            self.resultFetched.emit(self._result(name, robots, score))

    def triggerResult(self, result: QgsLocatorResult):
        # QGIS looks a moment after the last letter. Whoever presses Enter sooner is given a row of what was
        # typed before, which may be another robot: what is typed counts.
        typed = self._typed_name()
        if typed is None:
            self._viewer.go_to(result.displayString)
            return
        robots = self._fleet.robots
        names = [name for _, name in rank_robots(typed, list(robots.rows))] if robots is not None else []
        if typed == self._last.text and result.displayString in names:
            self._viewer.go_to(result.displayString)
        elif names:
            self._viewer.go_to(names[0])

    def _typed_name(self) -> str | None:
        """Return what stands in the locator's field behind the prefix."""
        text = self._field.typed()
        if text is None:
            return None
        prefix, space, name = text.partition(" ")
        behind = name if space and prefix.casefold() == self.activePrefix().casefold() else text
        return behind.strip()

    def _result(self, name: str, robots: RobotSnapshot, score: float) -> QgsLocatorResult:
        state, age = robots.state(name), robots.silence(name)
        description = ROBOT_STATES[RobotState(state)]
        result = QgsLocatorResult()
        result.displayString = name
        result.description = (
            description
            if age is None
            else tr("{state}, heard of {age:.0f} s ago", state=description, age=age)
        )
        result.score = score
        result.icon = self._icons[RobotState(state)]
        return result


def rank_robots(pattern: str, names: list[str]) -> list[tuple[float, str]]:
    """Return the names that ``pattern`` is a part of, each with a score from 0 to 1, the best first.

    A name that is the same comes before one that begins so, and that before one that has it within.
    """
    pattern = pattern.strip().casefold()
    found = []
    for name in names:
        at = name.casefold().find(pattern)
        if at >= 0:
            same = len(name) == len(pattern)
            found.append((1.0 if same else 0.9 if at == 0 else 0.6, name))
    return sorted(found, key=lambda one: (-one[0], len(one[1]), one[1]))


PREFIX = "rb"
PREFIX_KEY = f"locator-filters/items/{NAME}/prefix"
"""Where QGIS keeps the prefix that the user has chosen."""
if Qgis.versionInt() < 33000:
    PREFIX_KEY = f"gui/locator_filters/prefix_{NAME}"


class RobotLocator:
    """The filter as long as the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, fleet: SnapshotHolder, viewer: RobotViewer):
        self._iface, self._filter = iface, RobotFilter(fleet, StateIcons(), viewer, self)
        settings = QgsSettings()
        # As if the user had chosen it: of plugins themselves QGIS takes none of less than three letters.
        if not settings.value(PREFIX_KEY, ""):
            settings.setValue(PREFIX_KEY, PREFIX)
        iface.registerLocatorFilter(self._filter)

    def remove(self) -> None:
        """Take the filter out; QGIS deletes it. A prefix of the user's own stays."""
        self._iface.deregisterLocatorFilter(self._filter)
        settings = QgsSettings()
        if settings.value(PREFIX_KEY, "") == PREFIX:
            settings.remove(PREFIX_KEY)

    def typed(self) -> str | None:
        """Return what stands in the locator's field of the window, None where the window has none."""
        locator = self._iface.mainWindow().findChild(QgsLocatorWidget)
        field = None if locator is None else locator.findChild(QLineEdit)
        return None if field is None else field.text()
