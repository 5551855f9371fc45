"""What the network needs to know of each road: width, surface, direction, speed, closed or not, level."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from qgis.core import QgsExpression

from ...robot_bridge.roads.centrelines import BACKWARD, BOTH, FORWARD
from ..language import tr
from .layer_rules import LayerRules, as_flag, as_metres

_DIRECTIONS = {
    **dict.fromkeys(("both", "no", "false", "0", "f,t", "b", "none"), BOTH),
    **dict.fromkeys(("forward", "yes", "true", "1", "ft", "f", "->"), FORWARD),
    **dict.fromkeys(("backward", "reverse", "-1", "tf", "t", "<-"), BACKWARD),
}
_KMH = re.compile(r"\s*(\d+(?:[.,]\d+)?)\s*(km/h|kmh)?\s*", re.ASCII)
_MPH = re.compile(r"\s*(\d+(?:[.,]\d+)?)\s*mph\s*", re.ASCII)

WIDTH_FIELDS = ("width_m", "width")
DIRECTION_FIELDS = ("direction", "oneway", "one_way")
DIRECTION_TAGS = ("oneway",)
"""Of OpenStreetMap's tags; its ``direction`` says where a sign or a bench faces."""
ROUNDABOUTS = ("roundabout", "circular")
SPEED_FIELDS = ("speed_ms",)
KMH_FIELDS = ("maxspeed", "speed_limit")
LEVEL_FIELDS = ("level", "layer")


@dataclass(frozen=True)
class RoadExpressions:
    """QGIS expressions; an empty one stands for the fields that such layers usually have."""

    width: str = ""
    surface: str = ""
    direction: str = ""
    speed: str = ""
    closed: str = ""
    level: str = ""


@dataclass(frozen=True)
class Traffic:
    """How one road may be driven; ``speed`` in m/s is None where it is not known."""

    direction: int
    speed: float | None
    closed: bool
    level: int


@dataclass(frozen=True)
class RoadAttributes:
    """What is known of one road; ``width`` in metres is None where it is not known."""

    width: float | None
    surface: str
    traffic: Traffic


class RoadRules:
    """Evaluates the expressions of one layer of roads.

    :raises ExpressionError: when one of them is none, or reads a field that is not there.
    """

    def __init__(self, rules: LayerRules, given: RoadExpressions) -> None:
        self._rules = rules
        column = rules.column
        self._width = self._rule("width", given.width, *WIDTH_FIELDS)
        self._surface = self._rule("surface", given.surface, "surface")
        self._direction = self._direction_rule(given.direction)
        self._junction = None if given.direction else rules.rule("direction", column("junction"))
        self._speed = self._rule("speed", given.speed, *SPEED_FIELDS)
        self._kmh = None if self._speed else rules.rule("speed", column(*KMH_FIELDS))
        self._closed = self._rule("closed", given.closed, "closed")
        self._level = self._rule("level", given.level, *LEVEL_FIELDS)
        over_and_under = (1, "bridge"), (-1, "tunnel")
        self._structures = [
            (level, rules.rule("level", column(name))) for level, name in over_and_under if not given.level
        ]

    def of(self, notes: list[str]) -> RoadAttributes:
        """Return what is known of the road that the rules are at; what is not understood becomes a note."""
        surface = self._rules.value("surface", self._surface, notes)
        return RoadAttributes(
            width=self._rules.metres("width", self._width, notes),
            surface="" if surface is None else str(surface),
            traffic=self.traffic(notes),
        )

    def traffic(self, notes: list[str]) -> Traffic:
        """Return how the road that the rules are at may be driven."""
        return Traffic(
            direction=self._direction_of(notes),
            speed=self._speed_of(notes),
            closed=self._closed_of(notes),
            level=self._level_of(notes),
        )

    def _rule(self, what: str, given: str, *fields: str) -> QgsExpression | None:
        if given.strip():
            return self._rules.needed_rule(what, given)
        return self._rules.rule(what, self._rules.column(*fields))

    def _direction_rule(self, given: str) -> QgsExpression | None:
        if given.strip():
            return self._rules.needed_rule("direction", given)
        column = self._rules.own_column(*DIRECTION_FIELDS) or self._rules.column(*DIRECTION_TAGS)
        if not column:
            self._rules.warn_of_layer(
                tr(
                    "none of its fields direction, oneway, one_way and other_tags is there to tell one-way "
                    "roads; all are taken as driven both ways"
                )
            )
        return self._rules.rule("direction", column)

    def _value(self, what: str, rule: QgsExpression | None, notes: list[str]) -> Any:
        value = self._rules.value(what, rule, notes)
        return None if value is None or str(value).strip() == "" else value

    def _direction_of(self, notes: list[str]) -> int:
        value = self._value("direction", self._direction, notes)
        if value is None:
            junction = self._value("direction", self._junction, notes)
            # OpenStreetMap: a roundabout is one-way where it does not say otherwise.
            return FORWARD if junction in ROUNDABOUTS else BOTH
        direction = _DIRECTIONS.get(str(value).strip().lower())
        if direction is None:
            notes.append(
                tr(
                    "its direction {value!r} is none of yes, -1 and no; it is taken as driven both ways",
                    value=value,
                )
            )
        return direction or BOTH

    def _speed_of(self, notes: list[str]) -> float | None:
        value = self._value("speed", self._speed or self._kmh, notes)
        if value is None:
            return None
        speed = as_metres(value) if self._speed else _from_kmh(value)
        if speed is None or speed <= 0:
            notes.append(tr("its speed {value!r} is no number above 0; the default is used", value=value))
            return None
        return speed

    def _closed_of(self, notes: list[str]) -> bool:
        value = self._value("closed", self._closed, notes)
        closed = False if value is None else as_flag(value)
        if closed is None:
            notes.append(
                tr(
                    "whether it is closed, {value!r}, is neither true nor false; it is taken as closed",
                    value=value,
                )
            )
        return closed is not False

    def _level_of(self, notes: list[str]) -> int:
        value = self._value("level", self._level, notes)
        number = None if value is None else as_metres(value)
        if value is not None and number is None:
            notes.append(tr("its level {value!r} is no number; it is taken to be on the ground", value=value))
        if number is not None:
            return round(number)
        for level, rule in self._structures:
            there = self._value("level", rule, notes)
            # Kinds of bridges and tunnels are many; none is called no, or F as in Geofabrik's shapefiles.
            if there is not None and as_flag(there) is not False and str(there).strip() not in ("F", "f"):
                return level
        return 0


def _from_kmh(value: Any) -> float | None:
    text = str(value).lower()
    for pattern, factor in ((_KMH, 1 / 3.6), (_MPH, 0.44704)):
        if match := pattern.fullmatch(text):
            return float(match[1].replace(",", ".")) * factor
    return None
