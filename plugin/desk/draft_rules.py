"""All that a draft is held against: site, map, layers, other robots' targets, and what its robot is doing."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from qgis.core import QgsProject
from qgis.PyQt.QtCore import QObject, pyqtSignal

from .checks import LayerCheck, check_bounds, check_map
from .command_book import CommandBook
from .drafting.ability_check import check_abilities, has
from .drafting.order_check import check_heard, check_orders
from .drafting.target_check import TargetCheck
from .drafts import Draft, Findings
from .picture import RobotView
from .placement import Placement
from .queue_book import QueueBook
from .time_slices import Steps


class DraftRules(QObject):
    """Looks at drafts for the ``operator``, on the site as ``placement`` puts it on the map now.

    ``view`` tells how a robot stands at this moment.
    """

    changed = pyqtSignal()
    """A layer is not as it was: what is under way has to begin anew."""

    def __init__(
        self,
        project: QgsProject,
        placement: Callable[[], Placement],
        operator: Callable[[], str],
        book: CommandBook,
        queues: QueueBook,
        view: Callable[[str], RobotView | None],
        parent: QObject,
    ):
        super().__init__(parent)
        self._placement = placement
        self._operator = operator
        self._book = book
        self._view = view
        self._layers = LayerCheck(project, self)
        self._layers.changed.connect(self.changed)
        self._targets = TargetCheck(book, queues)

    def look(self, draft: Draft, afresh: bool) -> Steps[Draft]:
        """Look at a draft, all of it ``afresh`` or only what is new; return it with what was found.

        An override holds for what was found when it was given: it is gone when something else is found.

        :raises FleetError: when there is no site or a layer cannot be read.
        """
        placement = self._placement()
        found = check_bounds(draft.points, placement.site) + check_map(placement)
        found += yield from self._layers.look(draft, placement, afresh)
        found += _of_way(draft)
        # At the end, so that nobody is sent there meanwhile.
        found += self._targets.look(draft)
        robot = self._view(draft.robot)
        found += check_heard(draft, robot) + check_abilities(draft, robot)
        found += check_orders(draft, self._book.task_of(draft.robot), self._operator())
        override = draft.override if found.overridable == draft.findings.overridable else None
        cones = has(robot, "cones")
        return replace(draft, findings=found, override=override, is_checked=True, places_cone=cones)

    def take_targets(self, robots: Iterable[str]) -> None:
        """Take in that something new is known of what these robots have to do."""
        self._targets.take(robots)

    def forget_targets(self) -> None:
        """Forget what every robot has to do."""
        self._targets.clear()

    def remove(self) -> None:
        """Watch the project's layers no more."""
        self._layers.remove()


def _of_way(draft: Draft) -> Findings:
    """Return what is to be told of the way to a target, besides what is in it."""
    way = draft.way
    if way.refusal:
        return Findings(refused=(way.refusal,), of_way=(way.refusal,))
    if way.note and not way.is_along_roads:
        return Findings(warnings=(way.note,), of_way=(way.note,))
    return Findings()
