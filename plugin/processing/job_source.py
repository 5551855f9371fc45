"""Cones, robots and stores, read from point layers by the names of their fields."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ...robot_bridge.assignment.job import PLACE, TO_STORE, Job, Robot, Store, Target
from ...robot_bridge.compass import theta_of
from ..assignment_words import FINISHES, TASKS
from ..language import tr
from ..sites.placing import SitePlacing
from ..sites.point_rows import PointRow, point_rows
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .named_choice import named_choice

CONES, ROBOTS, STORES = "CONES", "ROBOTS", "STORES"
TASK, FINISH, STAGE_FIELD = "TASK", "FINISH", "STAGE_FIELD"
_REAL = QgsProcessingParameterNumber.Type.Double
_WHOLE = QgsProcessingParameterNumber.Type.Integer
_NAMES = ("id", "robot", "name")
"""Fields that may hold the id of a feature; the first that the layer has."""
_NUMBERS = {
    "CAPACITY": (tr("Cones that a robot carries (default of field capacity)"), _WHOLE, 8, 1),
    "ROBOT_SPEED": (tr("Speed of a robot [m/s] (default of field speed)"), _REAL, 1.0, 0.01),
    "RANGE": (
        tr("Metres that a robot's battery lasts, 0 for any (default of field range_m)"),
        _REAL,
        0.0,
        0.0,
    ),
    "SERVICE_TIME": (tr("Seconds to place or collect a cone (default of field service_s)"), _REAL, 10.0, 0.0),
    "STORE_TIME": (tr("Seconds of a visit to a store (default of its field service_s)"), _REAL, 30.0, 0.0),
}


def job_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters that say what is to be done and by whom."""
    points = [QgsProcessing.SourceType.TypeVectorPoint]
    return [
        QgsProcessingParameterFeatureSource(CONES, tr("Cones"), points),
        QgsProcessingParameterFeatureSource(ROBOTS, tr("Robots, where they are"), points),
        QgsProcessingParameterFeatureSource(STORES, tr("Stores of cones"), points, optional=True),
        named_choice(TASK, tr("What is done with cones (default of field task)"), TASKS, PLACE),
        QgsProcessingParameterString(
            STAGE_FIELD, tr("Field of the stage: cones of lower ones come first"), "stage", optional=True
        ),
        *(
            QgsProcessingParameterNumber(name, title, kind, value, minValue=least)
            for name, (title, kind, value, least) in _NUMBERS.items()
        ),
        named_choice(FINISH, tr("Where robots go at the end"), FINISHES, TO_STORE),
    ]


class JobSource:
    """The layers of one run."""

    def __init__(
        self, algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
    ) -> None:
        self._algorithm, self._parameters, self._context = algorithm, parameters, context

    def source(self, name: str) -> QgsProcessingFeatureSource | None:
        """Return the layer of parameter ``name``; None where it is not given.

        :raises ParameterError: when it cannot be opened.
        """
        given = self._parameters.get(name)
        source = self._algorithm.parameterAsSource(self._parameters, name, self._context)
        if source is None and given not in (None, ""):
            raise ParameterError(
                tr(
                    "{name} {given} cannot be opened: check the file and the layer's name.",
                    name=name,
                    given=given,
                )
            )
        return source

    def read(self, crs: QgsCoordinateReferenceSystem) -> Job:
        """Return what is to be done, with coordinates in ``crs``.

        :raises ParameterError: when a layer cannot be opened; LayerReadingError naming layer, feature and
            field that cannot be used; JobError when what they say cannot be planned for.
        """
        number = {name: self._number(name) for name in _NUMBERS}
        return Job(
            tuple(self._target(row, number) for row in self._rows(CONES, crs)),
            tuple(_robot(row, number) for row in self._rows(ROBOTS, crs)),
            tuple(
                Store(row.name, row.x, row.y, row.number("service_s", number["STORE_TIME"]))
                for row in self._rows(STORES, crs)
            ),
            self._algorithm.parameterAsEnumString(self._parameters, FINISH, self._context),
        )

    def _number(self, name: str) -> float:
        return self._algorithm.parameterAsDouble(self._parameters, name, self._context)

    def _target(self, row: PointRow, number: dict[str, float]) -> Target:
        text = self._algorithm.parameterAsString
        stage = text(self._parameters, STAGE_FIELD, self._context).strip()
        task = self._algorithm.parameterAsEnumString(self._parameters, TASK, self._context)
        return Target(
            row.name,
            row.x,
            row.y,
            theta_of(row.number("heading", 90.0)),
            row.whole(stage, 0) if stage else 0,
            str(row.values.get("task") or task),
            row.whole("demand", 1),
            row.number("service_s", number["SERVICE_TIME"]),
        )

    def _rows(self, name: str, crs: QgsCoordinateReferenceSystem) -> Iterator[PointRow]:
        source = self.source(name)
        if source is None:
            return
        site = SitePlacing.in_crs(crs, self._context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        yield from point_rows(source.sourceName(), source.getFeatures(), placing, _NAMES)


def _robot(row: PointRow, number: dict[str, float]) -> Robot:
    # Of a range, 0 says that it does not matter.
    metres = row.number("range_m", number["RANGE"]) or math.inf
    return Robot(
        row.name,
        row.x,
        row.y,
        row.whole("capacity", number["CAPACITY"]),
        row.number("speed", number["ROBOT_SPEED"]),
        metres,
        row.whole("aboard", 0),
        row.whole("collected", 0),
        row.number("ready_s", 0.0),
    )


def layers_crs(sources: Sequence[QgsProcessingFeatureSource | None]) -> list[QgsCoordinateReferenceSystem]:
    """Return the CRSs of the layers that are given."""
    return [source.sourceCrs() for source in sources if source is not None]
