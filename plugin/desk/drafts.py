"""What the operator is about to ask for: on the canvas, not sent yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.messages import SetPath, SetPosEnd, to_json

Point = tuple[float, float]


@dataclass(frozen=True)
class Findings:
    """What a check of a draft found: ``refused`` forbids sending it, ``warnings`` do not."""

    refused: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def __add__(self, other: Findings) -> Findings:
        return Findings(self.refused + other.refused, self.warnings + other.warnings)


@dataclass(frozen=True)
class Draft:
    """A cone target (one point) or a route (its points), metres in the site frame, for one robot.

    ``robot`` is the one that was selected when the draft was begun; another selection does not change it.
    """

    robot: str
    kind: str
    points: tuple[Point, ...]
    findings: Findings = field(default_factory=Findings)

    @property
    def fault(self) -> str | None:
        """Why it cannot be sent, None if it can."""
        if self.kind == ROUTE and len(self.points) < 2:
            return "a route needs at least two points: click the next one"
        return " ".join(self.findings.refused) or None

    def message(self) -> tuple[str, dict[str, Any]]:
        """Return the operation and its parameters."""
        if self.kind == CONE:
            (x, y) = self.points[0]
            return SetPosEnd.__name__, to_json(SetPosEnd(x, y, cone=True))
        return SetPath.__name__, to_json(SetPath(list(self.points)))

    def in_words(self) -> str:
        """Return what would be sent to whom."""
        if self.kind == CONE:
            return f"Cone for {self.robot} at {self.points[0][0]:.2f}, {self.points[0][1]:.2f} m"
        return f"Route for {self.robot}: {len(self.points)} points, {_length(self.points):.1f} m"


CONE = "cone"
ROUTE = "route"


class DraftBoard(QObject):
    """Holds the one draft that there can be and tells who shows it when it changes."""

    changed = pyqtSignal()
    pointed = pyqtSignal()

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self.draft: Draft | None = None
        self.cursor: Point | None = None

    def put(self, draft: Draft | None) -> None:
        """Make ``draft`` the one, None for no draft."""
        self.draft = draft
        self.cursor = None
        self.changed.emit()

    def point_at(self, cursor: Point | None) -> None:
        """Say where the mouse is, in the site frame, for the preview of the next leg."""
        self.cursor = cursor
        self.pointed.emit()


def _length(points: tuple[Point, ...]) -> float:
    legs = pairwise(points)
    return sum(((bx - ax) ** 2 + (by - ay) ** 2) ** 0.5 for (ax, ay), (bx, by) in legs)
