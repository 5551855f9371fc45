"""One piece of ground to drive on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from ..centrelines import Floats

Origin = Literal["drawn", "generated"]
"""Where a surface comes from: a person's hand, or the widths of centrelines."""

DRAWN: Final = "drawn"
GENERATED: Final = "generated"


@dataclass(frozen=True)
class Surface:
    """One polygon of a class such as ``asphalt``, its ``label``.

    ``rings`` holds the outer ring and then its holes, each (n, 2), metres in the site frame, closed.
    ``origin`` is DRAWN or GENERATED.
    """

    rings: tuple[Floats, ...]
    label: str
    name: str = ""
    origin: Origin = DRAWN
