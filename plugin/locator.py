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
"""Results: nobody reads more, and the list is made again with each letter."""
SAME = 1.0
"""The score of the very name that was looked for."""
OTHER_CASE = 0.95
"""The score of that name in other letters, small or capital; of several nobody knows which was meant."""
CHOICE_FOR_S = 3.0
"""Seconds for which a choice waits for what the gateway finds."""


class RobotMatch(NamedTuple):
    """A robot that holds what was looked for in its name, and how well."""

    name: str
    score: float
    state: RobotState
    age: float | None


class RobotList:
    """The robots that the desk knows or the gateway found; what was looked for last, and listed of it.

    It is one for the filter and its clones, which are gone when a result is chosen.
    """

    def __init__(self, fleet: SnapshotHolder, search: RobotSearch):
        self._fleet, self._search = fleet, search
        self.text = ""
        self._listed: dict[str, float] = {}
        """The scores of the robots that are listed."""

    def begin(self, text: str) -> list[RobotMatch]:
        """Look for ``text``, at the gateway too, and return what is known already, the best first."""
        self._search.search(text)
        self.text, self._listed = text, {}
        return self.more()

    def more(self) -> list[RobotMatch]:
        """Return what is known by now and not listed yet of what was looked for, and count it as listed."""
        robots, now = self._fleet.robots, steady_time()
        if robots is None:
            return []
        found = {robot.name: robot for robot in self._search.found(self.text)}
        best = [(score, name) for score, name in self._ranked(self.text)[:MOST] if name not in self._listed]
        self._listed.update({name: score for score, name in best})
        return [_match(name, score, robots, found.get(name), now) for score, name in best]

    def names(self, text: str) -> list[str]:
        """Return the names that ``text`` is a part of, the best first."""
        return [name for _, name in self._ranked(text)]

    def has(self, text: str) -> bool:
        """Tell whether a robot is known whose very name ``text`` is, letter by letter."""
        return bool(ranked := self._ranked(text)) and ranked[0][0] == SAME

    def named(self, text: str) -> str | None:
        """Return the robot whose very name ``text`` is, or the only one of that name in another case."""
        ranked = self._ranked(text)[:2]
        if not ranked or ranked[0][0] < OTHER_CASE:
            return None
        is_one_of_several = len(ranked) > 1 and ranked[0][0] == ranked[1][0]
        return None if is_one_of_several else ranked[0][1]

    def is_listed(self, robot: str, text: str) -> bool:
        """Tell whether ``robot`` was listed when ``text`` was looked for last, and is there still."""
        robots = self._fleet.robots
        if text != self.text or robot not in self._listed or robots is None:
            return False
        # One that is out of view by now is there all the same.
        return robot in robots.rows or not robots.is_whole

    def is_marked_by_hand(self, robot: str) -> bool:
        """Tell whether QGIS did not mark this robot, which is listed, by itself for want of a better one."""
        # Of those with the best score QGIS marks one, in its own order.
        score = self._listed[robot]
        return score == SAME or score < max(self._listed.values())

    def expects_more(self, text: str) -> bool:
        """Tell whether the gateway has still to say which robots there are; it is asked."""
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
    """Who shows a robot: the window."""

    def go_to(self, robot: str) -> None:
        """Select a robot alone and show where it is."""


class LocatorField(Protocol):
    """Who knows the locator's field."""

    def typed(self) -> str | None:
        """Return what stands in the field, None where there is none."""


@dataclass(frozen=True)
class Choice:
    """What was typed when a row was chosen that may be another robot's, and the row; until when it counts."""

    typed: str
    row: str
    until: float


class RobotFilter(QgsLocatorFilter):
    """Finds robots by any part of their name, and has ``viewer`` show the one that was chosen.

    ``field`` knows what stands in the locator's field.

    QGIS looks with a clone of the filter, in the window's thread: it is fast. In a thread of its own it could
    wait for Python for ever, where the plugin is unloaded meanwhile and QGIS waits for that thread.
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
        # Shorter ones of plugins are passed over, unless the user has chosen them: see RobotLocator.
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
        """Return the results that came since, where what was looked for stands in the field still."""
        if self._typed_name() != self._robots.text:
            return []
        results = [self._result(match) for match in self._robots.more()]
        for result in results:
            # QGIS does so with what is fetched.
            result.filter = self
        return results

    def triggerResult(self, result: QgsLocatorResult):
        # QGIS looks a moment after the last letter. Whoever presses Enter sooner is given a row of what was
        # typed before, which may be another robot: what is typed counts.
        self._waiting = None
        typed, row = self._typed_name(), result.displayString
        if typed is None:
            self._viewer.go_to(row)
            return
        if self._robots.is_listed(row, typed) and self._robots.is_marked_by_hand(row):
            self._viewer.go_to(row)
        elif not self._robots.has(typed) and self._robots.expects_more(typed):
            self._waiting = Choice(typed, row, steady_time() + CHOICE_FOR_S)
        else:
            self._go_by(typed, row)

    def settle(self) -> None:
        """Go where was chosen to go before the gateway had said which robots there are."""
        choice = self._waiting
        if choice is None or self._robots.expects_more(choice.typed):
            return
        self._waiting = None
        if choice.typed == self._typed_name() and steady_time() < choice.until:
            self._go_by(choice.typed, choice.row)

    def withdraw(self) -> None:
        """Go nowhere by what was chosen before: something else was since."""
        self._waiting = None

    def _go_by(self, typed: str, row: str) -> None:
        """Go to the robot whose name was typed, else to that of the row, else to the best."""
        robot = self._robots.named(typed)
        if robot is None and self._robots.is_listed(row, typed):
            robot = row
        for name in [robot] if robot is not None else self._robots.names(typed)[:1]:
            self._viewer.go_to(name)

    def _typed_name(self) -> str | None:
        """Return what stands in the locator's field behind the prefix."""
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
    """Return the names that ``pattern`` is a part of, each with a score from 0 to 1, the best first.

    A name that is the same comes before one that is so in another case, then one that begins so, then one
    that has it within, shorter ones before longer ones: QGIS lists by the score.
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
"""Where QGIS keeps the prefix that the user has chosen."""
if Qgis.versionInt() < 33000:
    PREFIX_KEY = f"gui/locator_filters/prefix_{NAME}"


class RobotLocator(QObject):
    """The filter as long as the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(
        self, iface: QgisInterface, fleet: SnapshotHolder, desk: FleetController, viewer: RobotViewer
    ):
        super().__init__(desk)
        self._iface, self._desk = iface, desk
        self._filter = RobotFilter(RobotList(fleet, desk.search), StateIcons(), viewer, self)
        desk.search.answered.connect(self._show_found)
        desk.selection.changed.connect(self._filter.withdraw)
        settings = QgsSettings()
        # As if the user had chosen it: of plugins themselves QGIS takes none of less than three letters.
        if not settings.value(PREFIX_KEY, ""):
            settings.setValue(PREFIX_KEY, PREFIX)
        iface.registerLocatorFilter(self._filter)

    def remove(self) -> None:
        """Take the filter out; QGIS deletes it. A prefix of the user's own stays."""
        self._desk.search.answered.disconnect(self._show_found)
        self._desk.selection.changed.disconnect(self._filter.withdraw)
        self._iface.deregisterLocatorFilter(self._filter)
        settings = QgsSettings()
        if settings.value(PREFIX_KEY, "") == PREFIX:
            settings.remove(PREFIX_KEY)

    def typed(self) -> str | None:
        """Return what stands in the locator's field of the window, None where the window has none."""
        widget = self._widget()
        field = None if widget is None else widget.findChild(QLineEdit)
        return None if field is None else field.text()

    def _widget(self) -> QgsLocatorWidget | None:
        return self._iface.mainWindow().findChild(QgsLocatorWidget)

    def _show_found(self) -> None:
        """Add what the gateway found to the list; QGIS marks the first row until the operator moves on."""
        if (widget := self._widget()) is not None:
            # To search again would ask all filters again, and take the mark from the operator's row.
            for result in self._filter.further_results():
                widget.locator().foundResult.emit(result)
        self._filter.settle()
