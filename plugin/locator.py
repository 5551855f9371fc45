"""Robots in QGIS's locator bar: the filter ``rb name``, and its registration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from qgis.core import Qgis, QgsFeedback, QgsLocatorContext, QgsLocatorFilter, QgsLocatorResult, QgsSettings
from qgis.gui import QgisInterface, QgsLocatorWidget
from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtWidgets import QLineEdit

from ..robot_bridge.core.clock import steady_time
from ..robot_bridge.core.messages.safety import RobotState
from .control.fleet_controller import FleetController
from .control.view_subscription import FoundRobot, RobotSearch
from .expressions import RobotSnapshot, SnapshotHolder
from .gateway_client.state_words import ROBOT_STATES
from .ui.glyphs import StateIcons
from .ui.language import tr

NAME = "fleet_robots"
MOST = 50
"""Results: nobody reads more, and the list is computed again with each letter."""
SAME = 1.0
"""The score of an exact match."""
OTHER_CASE = 0.95
"""The score of a match in another case; if there are several, it is unknown which was meant."""
CHOICE_FOR_S = 3.0
"""Seconds for which a choice waits for the gateway's search."""


class RobotMatch(NamedTuple):
    """A robot whose name contains the text, and its score."""

    name: str
    score: float
    state: RobotState
    age: float | None


class RobotList:
    """The robots known to the desk or found by the gateway; the last search text and its listed results.

    It is shared by the filter and its clones, which are gone when a result is chosen.
    """

    def __init__(self, fleet: SnapshotHolder, search: RobotSearch):
        self._fleet, self._search = fleet, search
        self.text = ""
        self._listed: dict[str, float] = {}
        """The scores of the robots that are listed."""

    def begin(self, text: str) -> list[RobotMatch]:
        """Start a search for ``text``, at the gateway too, and return the known results, the best first."""
        self._search.search(text)
        self.text, self._listed = text, {}
        return self.more()

    def more(self) -> list[RobotMatch]:
        """Return results of the search that are known by now and not listed yet, and count them as listed."""
        robots, now = self._fleet.robots, steady_time()
        if robots is None:
            return []
        found = {robot.name: robot for robot in self._search.found(self.text)}
        best = [(score, name) for score, name in self._ranked(self.text)[:MOST] if name not in self._listed]
        self._listed.update({name: score for score, name in best})
        return [_match(name, score, robots, found.get(name), now) for score, name in best]

    def names(self, text: str) -> list[str]:
        """Return the names that contain ``text``, the best first."""
        return [name for _, name in self._ranked(text)]

    def has(self, text: str) -> bool:
        """Return whether a robot with exactly the name ``text`` is known."""
        return bool(ranked := self._ranked(text)) and ranked[0][0] == SAME

    def named(self, text: str) -> str | None:
        """Return the robot with exactly the name ``text``, or the only one of that name in another case."""
        ranked = self._ranked(text)[:2]
        if not ranked or ranked[0][0] < OTHER_CASE:
            return None
        is_one_of_several = len(ranked) > 1 and ranked[0][0] == ranked[1][0]
        return None if is_one_of_several else ranked[0][1]

    def is_listed(self, robot: str, text: str) -> bool:
        """Return whether ``robot`` was listed when ``text`` was last searched, and still exists."""
        robots = self._fleet.robots
        if text != self.text or robot not in self._listed or robots is None:
            return False
        # One that is out of view by now exists all the same.
        return robot in robots.rows or not robots.is_whole

    def is_marked_by_hand(self, robot: str) -> bool:
        """Return whether QGIS did not mark this listed robot merely as the best one available."""
        # QGIS marks one of those with the best score, in its own order.
        score = self._listed[robot]
        return score == SAME or score < max(self._listed.values())

    def expects_more(self, text: str) -> bool:
        """Return whether the gateway's search results are still to come; the search is sent."""
        self._search.search(text)
        return self._search.awaits(text)

    def _ranked(self, text: str) -> list[tuple[float, str]]:
        robots = self._fleet.robots
        if robots is None:
            return []
        found = dict.fromkeys(robot.name for robot in self._search.found(text))
        return rank_robots(text, list({**robots.rows, **found}))


def _match(
    name: str, score: float, robots: RobotSnapshot, found: FoundRobot | None, now: float
) -> RobotMatch:
    state = robots.state(name)
    if state is None and found is not None:
        return RobotMatch(name, score, found.state, max(0.0, now - found.heard))
    return RobotMatch(name, score, RobotState(state), robots.silence(name, now))


class RobotViewer(Protocol):
    """A window that shows robots."""

    def show_on_map(self, robot: str) -> None:
        """Select a robot alone and show it on the map."""


class LocatorField(Protocol):
    """Access to the locator's field."""

    def typed(self) -> str | None:
        """Return the text in the field, None where there is none."""


@dataclass(frozen=True)
class Choice:
    """The text typed when a row was chosen that may be another robot's, the row, and its expiry."""

    typed: str
    row: str
    until: float


class RobotFilter(QgsLocatorFilter):
    """Finds robots by any part of their name, and has ``viewer`` show the chosen one.

    ``field`` gives access to the locator's field.

    QGIS searches with a clone of the filter, in the window's thread: it is fast. In a thread of its own it
    could wait for Python's lock for ever, if the plugin is unloaded meanwhile and QGIS waits for that thread.
    """

    def __init__(self, robots: RobotList, icons: StateIcons, viewer: RobotViewer, field: LocatorField):
        super().__init__()
        self._robots, self._icons, self._viewer, self._field = robots, icons, viewer, field
        self._waiting: Choice | None = None

    def clone(self):
        return RobotFilter(self._robots, self._icons, self._viewer, self._field)

    def name(self):
        return NAME

    def displayName(self):
        return tr("Robots")

    def flags(self):
        return QgsLocatorFilter.Flag.FlagFast

    def prefix(self):
        # Shorter ones of plugins are ignored, unless the user has chosen them: see RobotLocator.
        return "robot"

    def priority(self):
        return QgsLocatorFilter.Priority.High

    def fetchResults(self, string: str, context: QgsLocatorContext, feedback: QgsFeedback):
        text = string.strip()
        matches = self._robots.begin(text)
        if not text and not context.usingPrefix:
            return
        for match in matches:
            if feedback.isCanceled():
                return
            self.resultFetched.emit(self._result(match))

    def further_results(self) -> list[QgsLocatorResult]:
        """Return the results that arrived since, if the text searched for is still in the field."""
        if self._typed_name() != self._robots.text:
            return []
        results = [self._result(match) for match in self._robots.more()]
        for result in results:
            # QGIS does so with fetched results.
            result.filter = self
        return results

    def triggerResult(self, result: QgsLocatorResult):
        # QGIS searches a moment after the last letter. Pressing Enter sooner chooses a row for the text
        # typed before, which may be another robot: the text typed counts.
        self._waiting = None
        typed, row = self._typed_name(), result.displayString
        if typed is None:
            self._viewer.show_on_map(row)
            return
        if self._robots.is_listed(row, typed) and self._robots.is_marked_by_hand(row):
            self._viewer.show_on_map(row)
        elif not self._robots.has(typed) and self._robots.expects_more(typed):
            self._waiting = Choice(typed, row, steady_time() + CHOICE_FOR_S)
        else:
            self._go_by(typed, row)

    def settle(self) -> None:
        """Carry out a choice made before the gateway had reported the robots."""
        choice = self._waiting
        if choice is None or self._robots.expects_more(choice.typed):
            return
        self._waiting = None
        if choice.typed == self._typed_name() and steady_time() < choice.until:
            self._go_by(choice.typed, choice.row)

    def withdraw(self) -> None:
        """Drop an earlier choice: another one was made since."""
        self._waiting = None

    def _go_by(self, typed: str, row: str) -> None:
        """Go to the robot whose name was typed, else to that of the row, else to the best."""
        robot = self._robots.named(typed)
        if robot is None and self._robots.is_listed(row, typed):
            robot = row
        for name in [robot] if robot is not None else self._robots.names(typed)[:1]:
            self._viewer.show_on_map(name)

    def _typed_name(self) -> str | None:
        """Return the text in the locator's field after the prefix."""
        text = self._field.typed()
        if text is None:
            return None
        prefix, space, name = text.partition(" ")
        behind = name if space and prefix.casefold() == self.activePrefix().casefold() else text
        return behind.strip()

    def _result(self, match: RobotMatch) -> QgsLocatorResult:
        description = ROBOT_STATES[match.state]
        result = QgsLocatorResult()
        result.displayString = match.name
        result.description = (
            description
            if match.age is None
            else tr("{state}, heard of {age:.0f} s ago", state=description, age=match.age)
        )
        result.score = match.score
        result.icon = self._icons[match.state]
        return result


def rank_robots(pattern: str, names: list[str]) -> list[tuple[float, str]]:
    """Return the names that contain ``pattern``, each with a score from 0 to 1, the best first.

    An exact match comes before one in another case, then names that begin with it, then names that
    contain it, shorter ones before longer ones: QGIS sorts by the score.
    """
    pattern = pattern.strip()
    folded = pattern.casefold()
    found = []
    for name in names:
        at = name.casefold().find(folded)
        if at >= 0:
            begins = (0.9 if at == 0 else 0.6) - len(name) / 1000
            is_whole = len(name) == len(folded)
            found.append((SAME if name == pattern else OTHER_CASE if is_whole else begins, name))
    return sorted(found, key=lambda one: (-one[0], one[1]))


PREFIX = "rb"
PREFIX_KEY = f"locator-filters/items/{NAME}/prefix"
"""QGIS's setting with the prefix chosen by the user."""
if Qgis.versionInt() < 33000:
    PREFIX_KEY = f"gui/locator_filters/prefix_{NAME}"


class RobotLocator(QObject):
    """The filter while the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(
        self, iface: QgisInterface, fleet: SnapshotHolder, desk: FleetController, viewer: RobotViewer
    ):
        super().__init__(desk)
        self._iface, self._desk = iface, desk
        self._filter = RobotFilter(RobotList(fleet, desk.search), StateIcons(), viewer, self)
        desk.search.answered.connect(self._show_found)
        desk.selection.changed.connect(self._filter.withdraw)
        settings = QgsSettings()
        # As if the user had chosen it: of plugins themselves QGIS accepts none of less than three letters.
        if not settings.value(PREFIX_KEY, ""):
            settings.setValue(PREFIX_KEY, PREFIX)
        iface.registerLocatorFilter(self._filter)

    def remove(self) -> None:
        """Remove the filter, which QGIS deletes. A prefix chosen by the user stays."""
        self._desk.search.answered.disconnect(self._show_found)
        self._desk.selection.changed.disconnect(self._filter.withdraw)
        self._iface.deregisterLocatorFilter(self._filter)
        settings = QgsSettings()
        if settings.value(PREFIX_KEY, "") == PREFIX:
            settings.remove(PREFIX_KEY)

    def typed(self) -> str | None:
        """Return the text in the locator's field of the window, None where the window has none."""
        widget = self._widget()
        field = None if widget is None else widget.findChild(QLineEdit)
        return None if field is None else field.text()

    def _widget(self) -> QgsLocatorWidget | None:
        return self._iface.mainWindow().findChild(QgsLocatorWidget)

    def _show_found(self) -> None:
        """Add the gateway's results to the list; QGIS marks the first row until the operator moves on."""
        if (widget := self._widget()) is not None:
            # A new search would query all filters again, and move the mark from the operator's row.
            for result in self._filter.further_results():
                widget.locator().foundResult.emit(result)
        self._filter.settle()
