"""What plans of cones can be, in the operator's language; files and parameters name it as the bridge does."""

from __future__ import annotations

from ..robot_bridge.assignment.job import COLLECT, PLACE, STAY, TO_START, TO_STORE
from ..robot_bridge.assignment.scheduling import BALANCED, LEAST_DISTANCE
from ..robot_bridge.assignment.solving import AUTOMATIC, PREVIEW, PREVIEW_KEPT, PYVRP
from .language import tr

TASKS = {PLACE: tr("place them"), COLLECT: tr("collect them")}
FINISHES = {STAY: tr("stay where they are"), TO_STORE: tr("drive to a store"), TO_START: tr("drive back")}
OBJECTIVES = {BALANCED: tr("done as early as possible"), LEAST_DISTANCE: tr("fewest metres")}
METHODS = {
    AUTOMATIC: tr("the best that is installed"),
    PYVRP: "PyVRP",
    PREVIEW: tr("the preview: quick, not the best"),
}
FOUND = {
    PREVIEW: tr("quick preview"),
    PYVRP: tr("solved"),
    PREVIEW_KEPT: tr("solved: nothing better than the preview was found"),
}
"""How good a plan is, by the method that found it."""
