"""The obstacles of an export: read from their layers, then reduced to what is asked for."""

from __future__ import annotations

from qgis.core import QgsProcessingFeedback, QgsProcessingMultiStepFeedback

from ...robot_bridge.robotmap.builder import build_map
from ...robot_bridge.robotmap.errors import CancelledError
from ...robot_bridge.robotmap.model import Border
from ...robot_bridge.robotmap.outlines import Outlines
from ...robot_bridge.robotmap.shaping import Shaping, shaped
from ...robot_bridge.robotmap.window import Window
from ..language import tr
from ..sites.reading import Reading, read_outlines
from .export_plan import ObstaclePlan
from .obstacle_words import obstacles_in_words


def obstacle_outlines(
    plan: ObstaclePlan, area: Border, feedback: QgsProcessingFeedback
) -> tuple[Reading, Outlines] | None:
    """Return what was read in ``area`` and the outlines of which maps are built; None after a cancel.

    :raises LayerReadingError: when a layer cannot be read.
    :raises MissingGeometryError: when a package is missing.
    """
    reduces = plan.shaping != Shaping()
    steps = QgsProcessingMultiStepFeedback(2 if reduces else 1, feedback)
    reading = read_outlines(plan.sources, plan.site, area, plan.default_height, steps)
    if not reading.complete:
        return None
    if not reduces:
        return reading, reading.outlines()
    steps.setCurrentStep(1)
    outlines = _reduced(reading.outlines(), plan.shaping, Window.from_bounds(*area), steps)
    return None if outlines is None else (reading, outlines)


def _reduced(
    outlines: Outlines, shaping: Shaping, area: Window, feedback: QgsProcessingFeedback
) -> Outlines | None:
    """Return the reduced outlines, None after a cancel; say what is other in ``area`` for it."""
    feedback.setProgressText(tr("Reducing obstacles"))
    try:
        made = shaped(outlines, shaping, lambda share: feedback.setProgress(100 * share), feedback.isCanceled)
    except CancelledError:
        return None
    before, after = (_counts(some, area) for some in (outlines, made))
    # Fewer walls can be more obstacles: what is left of a ring is open chains.
    feedback.pushInfo(
        tr(
            "{before} became {after}",
            before=obstacles_in_words(*before),
            after=obstacles_in_words(*after),
        )
    )
    return made


def _counts(outlines: Outlines, area: Window) -> tuple[int, int]:
    robot_map = build_map(outlines, area)
    return len(robot_map.obstacles), robot_map.segment_count
