"""Furniture that is drawn as points: the small closed shape that stands for each."""

from __future__ import annotations

import math

import numpy as np
from qgis.core import QgsFeature, QgsGeometry

from ...robot_bridge.robotmap.errors import ShapingError
from ...robot_bridge.robotmap.model import ShapeType
from ...robot_bridge.robotmap.templates import Template, template
from ..language import tr
from .layer_rules import LayerRules
from .roles import LayerExpressions
from .shapes import NO_PLACE, Shape, Shapes

POST_ACROSS_M = 0.5
"""How far across a piece of furniture is that is drawn as a point and says nothing of its size."""

REACH_M = 100.0
"""How far the shape of a point can reach from it: a triangle around the largest circle there is."""


class Posts:
    """Makes shapes of points by the expressions of one layer: by template, else as an octagon of a width.

    :raises ExpressionError: when one of the expressions is none.
    """

    def __init__(self, rules: LayerRules, expressions: LayerExpressions):
        self._rules = rules
        self._width = rules.rule("width", expressions.width)
        self._template = rules.rule("template", expressions.template)
        self._rotation = rules.rule("rotation", expressions.rotation)

    def of(self, feature: QgsFeature, points: QgsGeometry) -> Shapes:
        """Return a shape around each of ``points``, the geometry of ``feature`` in metres.

        ``rotation`` turns it clockwise, so that a heading turns what faces north to face there.
        """
        places = np.array([(point.x(), point.y()) for point in points.vertices()]).reshape(-1, 2)
        if not np.isfinite(places).all():
            return Shapes([], [NO_PLACE])
        self._rules.at(feature)
        notes: list[str] = []
        made = self._named(notes) or self._round(notes)
        turned = -math.radians(self._degrees(notes))
        rings = [made.at(x, y, turned) for x, y in places.tolist()]
        return Shapes([Shape(ring, ShapeType.CLOSED_POLYGON) for ring in rings], notes)

    def _named(self, notes: list[str]) -> Template | None:
        value = self._rules.value("template", self._template, notes)
        if value is None or not str(value).strip():
            return None
        try:
            return template(str(value))
        except ShapingError as error:
            notes.append(tr("{error}; its width is used", error=error))
            return None

    def _round(self, notes: list[str]) -> Template:
        width = self._rules.metres("width", self._width, notes)
        try:
            return template(f"circle {POST_ACROSS_M if width is None else width}")
        except ShapingError:
            notes.append(
                tr(
                    "its width {width:g} m is none of furniture; {used:g} is used",
                    width=width,
                    used=POST_ACROSS_M,
                )
            )
            return template(f"circle {POST_ACROSS_M}")

    def _degrees(self, notes: list[str]) -> float:
        value = self._rules.value("rotation", self._rotation, notes)
        if value is None or value == "":
            return 0.0
        try:
            degrees = float(str(value).strip().rstrip("°"))
        except ValueError:
            degrees = math.nan
        if not math.isfinite(degrees):
            notes.append(
                tr("its rotation {value!r} is not a number of degrees; it is not turned", value=value)
            )
            return 0.0
        return degrees
