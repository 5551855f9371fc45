"""What every layout has: a name, the standard it follows, dimensions that can be changed, and cones."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import Enum, auto
from typing import Any, ClassVar

from .cone import Cone, Spot, numbered
from .errors import DimensionError

BASE_M = 0.285
"""Across the base of the cone of 505 mm of Formula Student; ISO 3888-2 asks for 500 mm of height or more."""


class Fault(Enum):
    """What a value of a dimension may be that it must not be."""

    NO_NUMBER = auto()
    NOT_CHOSEN = auto()
    TOO_SMALL = auto()
    NOT_WHOLE = auto()


@dataclass(frozen=True)
class Dimension:
    """One number of a layout: what it is, in which unit, and its value in the standard.

    Values are ``least`` or more, without a fraction where ``whole``, and one of ``choices`` where there are
    any: these are named by what they mean.
    """

    name: str
    text: str
    unit: str
    standard: float
    least: float
    whole: bool
    choices: Mapping[float, str]

    @property
    def choices_text(self) -> str:
        """Return the choices, the least one first."""
        return ", ".join(f"{choice:g}" for choice in sorted(self.choices))

    @property
    def whole_text(self) -> str:
        """Return what it is, with what each choice means."""
        meanings = ", ".join(f"{choice:g} {name}" for choice, name in self.choices.items())
        return f"{self.text}: {meanings}" if meanings else self.text

    def fault(self, value: float) -> Fault | None:
        """Return what is wrong with ``value``, None where nothing is."""
        if not math.isfinite(value):
            return Fault.NO_NUMBER
        if self.choices and value not in self.choices:
            return Fault.NOT_CHOSEN
        if value < self.least:
            return Fault.TOO_SMALL
        return Fault.NOT_WHOLE if self.whole and value != int(value) else None

    def problem(self, value: float) -> str:
        """Return what to give in place of ``value``, nothing where it is good."""
        fault = self.fault(value)
        if fault is None:
            return ""
        return {
            Fault.NO_NUMBER: "give a number",
            Fault.NOT_CHOSEN: f"give one of {self.choices_text}",
            Fault.TOO_SMALL: f"give {self.least:g} or more",
            Fault.NOT_WHOLE: "give a whole number",
        }[fault]


def dimension(standard: float, text: str, unit: str = "m", least: float = 0.0, **limits: Any) -> Any:
    """Return the field of a dimension; ``limits`` are ``whole`` and ``choices`` of :class:`Dimension`."""
    return field(default=standard, metadata={"text": text, "unit": unit, "least": least, **limits})


@dataclass(frozen=True)
class Layout(ABC):
    """A layout with its dimensions, in a frame of its own: x along the travel, y to the left, in metres.

    :raises DimensionError: when a dimension has a value that it cannot have.
    """

    NAME: ClassVar[str] = ""
    TITLE: ClassVar[str] = ""
    STANDARD: ClassVar[str] = ""

    cone_base: float = dimension(
        BASE_M, "Across the base of a cone; the cones touch the track's limits", least=0
    )

    def __post_init__(self) -> None:
        for one in self.dimensions():
            problem = one.problem(getattr(self, one.name))
            if problem:
                value = getattr(self, one.name)
                raise DimensionError(f"{self.NAME}: {one.name} is {value:g}: {problem}.")

    @classmethod
    def dimensions(cls) -> list[Dimension]:
        """Return every dimension of the layout."""
        unlimited: dict[str, Any] = {"least": 0.0, "whole": False, "choices": {}}
        return [
            Dimension(name=one.name, **{"standard": one.default, **unlimited, **one.metadata})
            for one in fields(cls)
        ]

    @classmethod
    def of(cls, values: Mapping[str, float]) -> Layout:
        """Return the layout with ``values`` in place of the standard's.

        :raises DimensionError: naming what the layout has, when a name is none of it.
        """
        known = [one.name for one in cls.dimensions()]
        for name in values:
            if name not in known:
                raise DimensionError(f"{cls.NAME} has no dimension {name!r}: give {', '.join(known)}.")
        return cls(**values)

    @abstractmethod
    def spots(self) -> list[Spot]:
        """Return where the cones stand, in the order of placing."""

    def cones(self, prefix: str = "") -> list[Cone]:
        """Return the cones, named after ``prefix`` or the layout."""
        return numbered(self.spots(), prefix or self.NAME)
