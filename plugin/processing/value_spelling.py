"""Values as a script spells them, where QGIS would take something else for them in silence.

QGIS passes over parameters that there are not, takes any word but "false" for true, and a word for no number
where a number may be left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from qgis.core import (
    QgsProcessingContext,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
)

from ..language import tr

_TRUTHS = ("true", "false", "1", "0")


def spelling_problem(
    definitions: Sequence[QgsProcessingParameterDefinition],
    parameters: Mapping[str, Any],
    context: QgsProcessingContext,
) -> str:
    """Return what is wrong with the first value that is not what it is taken for, or nothing."""
    known = {definition.name(): definition for definition in definitions}
    for name, value in parameters.items():
        if name not in known:
            return tr(
                "There is no parameter {name}: correct it or leave it out. There are: {names}.",
                name=name,
                names=", ".join(known),
            )
        wanted = _wanted(known[name], value, context)
        if wanted:
            return tr("{name} is {value}: give {wanted}.", name=name, value=value, wanted=wanted)
    return ""


def _wanted(definition: QgsProcessingParameterDefinition, value: Any, context: QgsProcessingContext) -> str:
    """Return what should stand in the place of ``value``, nothing where that is fine or QGIS tells it."""
    if not isinstance(value, str) or not value:
        return ""
    kind = definition.type()
    if kind == "boolean":
        return "" if value.lower() in _TRUTHS else tr("true or false")
    if kind in ("number", "distance"):
        return "" if _is_number(value) else tr("a number")
    if definition.checkValueIsAcceptable(value, context):
        return ""
    if isinstance(definition, QgsProcessingParameterEnum):
        return tr("one of {options}", options=", ".join(definition.options()))
    if kind == "point":
        return tr("'x,y', or 'x,y [EPSG:4326]' in another CRS")
    return tr("'xmin,xmax,ymin,ymax'") if kind == "extent" else ""


def _is_number(value: str) -> bool:
    try:
        # Python takes 1_000 for a number, QGIS does not.
        return math.isfinite(float(value)) and "_" not in value
    except ValueError:
        return False
