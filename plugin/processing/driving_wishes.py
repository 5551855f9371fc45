"""How robots drive and which roads they may use: what routes and assignments ask alike."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ...robot_bridge.roads.centrelines import Centrelines
from ...robot_bridge.roads.dense import Driving
from ...robot_bridge.roads.routes import REACH, Restrictions
from ..language import tr
from .fleet_algorithm import Parameters

SURFACES, LEAST_WIDTH, DISTANCE = "SURFACES", "LEAST_WIDTH", "DISTANCE"
SPACING, TURNING_RADIUS, ROBOT_WIDTH = "SPACING", "TURNING_RADIUS", "ROBOT_WIDTH"
_USUAL = Driving()
_LENGTHS = {
    LEAST_WIDTH: (tr("Roads at least this wide, and as wide as the robot [m]"), 0.0, 0.0),
    DISTANCE: (tr("Farthest place from a road [m]"), REACH, 0.0),
    SPACING: (tr("Points of the path at most this far apart [m]"), _USUAL.spacing, 0.01),
    TURNING_RADIUS: (tr("Turning radius of the robot [m]"), _USUAL.turning_radius, 0.0),
    ROBOT_WIDTH: (tr("Width of the robot [m]"), _USUAL.robot_width, 0.0),
}


@dataclass(frozen=True)
class DrivingWishes:
    """How paths are driven, which roads may be used, and how many metres a place may be away from one."""

    driving: Driving
    restrictions: Restrictions
    reach: float

    def doubts(self, roads: Centrelines) -> list[str]:
        """Return what to warn of: surfaces that none of ``roads`` has."""
        there = {str(surface) for surface in roads.surface}
        unknown = (self.restrictions.surfaces or frozenset()) - there
        if not unknown:
            return []
        none = tr("none")
        return [
            tr(
                "No road has the surface {surfaces}: the roads have {there}.",
                surfaces=", ".join(sorted(unknown)),
                there=", ".join(sorted(surface or f"({none})" for surface in there)) or none,
            )
        ]


def surfaces_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the surfaces that may be used."""
    return QgsProcessingParameterString(
        SURFACES, tr("Surfaces that may be used (default: all)"), optional=True
    )


def length_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters in metres."""
    real = QgsProcessingParameterNumber.Type.Double
    return [
        QgsProcessingParameterNumber(name, title, real, value, minValue=least)
        for name, (title, value, least) in _LENGTHS.items()
    ]


def driving_wishes(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> DrivingWishes:
    """Return what the parameters ask for; as in the gateway no way leads where the robot is too wide.

    :raises RoadInputError: when a number is none to drive by.
    """
    metres = {name: algorithm.parameterAsDouble(parameters, name, context) for name in _LENGTHS}
    names = algorithm.parameterAsString(parameters, SURFACES, context).split(",")
    surfaces = frozenset(name.strip() for name in names if name.strip())
    return DrivingWishes(
        Driving(metres[SPACING], metres[TURNING_RADIUS], metres[ROBOT_WIDTH]),
        Restrictions(surfaces=surfaces or None, least_width=max(metres[LEAST_WIDTH], metres[ROBOT_WIDTH])),
        metres[DISTANCE],
    )
