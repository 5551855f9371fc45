"""Errors on their way to whoever runs an algorithm."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from qgis.core import QgsApplication, QgsProcessingException, QgsProcessingFeedback

from ...robot_bridge.assignment.errors import AssignmentError
from ...robot_bridge.layouts.errors import LayoutsError
from ...robot_bridge.roads.errors import RoadsError
from ...robot_bridge.robotmap.errors import RobotMapError
from ..errors import FleetError
from ..language import tr


class ParameterError(FleetError):
    """A parameter of an algorithm cannot be used."""


@contextmanager
def shown_by_processing(feedback: QgsProcessingFeedback | None = None) -> Iterator[None]:
    """Turn errors of the plugin and of the bridge into what Processing shows without a traceback.

    With the ``feedback`` of a run also a cancel in ``qgis_process``, whose status would tell a script that
    all is there.
    """
    try:
        yield
    except (FleetError, RobotMapError, RoadsError, LayoutsError, AssignmentError) as error:
        raise QgsProcessingException(str(error)) from error
    if feedback is not None and feedback.isCanceled() and QgsApplication.platform() == "qgis_process":
        raise QgsProcessingException(tr("It was cancelled before its end."))
