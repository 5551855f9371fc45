"""Puts the plugin's expression functions into QGIS and takes them out again."""

from __future__ import annotations

from qgis.core import QgsExpression

from ..sites.surface_store import SurfaceStore
from .distance_to_robot import DistanceToRobot
from .road_surface import RoadSurface
from .robot_values import robot_values
from .robots_now import FleetNow


class ExpressionFunctions:
    """The functions as long as the plugin is loaded. :meth:`remove` undoes the constructor."""

    def __init__(self, surfaces: SurfaceStore, fleet: FleetNow):
        # QGIS does not keep Python's functions alive; what it does not take, as when two copies of the plugin
        # are loaded, is not ours to take out.
        made = [RoadSurface(surfaces), DistanceToRobot(fleet), *robot_values(fleet)]
        self._functions = [one for one in made if QgsExpression.registerFunction(one)]

    def remove(self) -> None:
        """Take every function out of QGIS."""
        for function in self._functions:
            QgsExpression.unregisterFunction(function.name())
        self._functions = []
