"""Parametric shapes: normals of ramps, templates of point obstacles."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import ShapingError

# --- Round things as chords, and the normals of ramps ---


def ramp_normal(points: NDArray[Any]) -> str:
    """Return the upward unit normal of a ramp's surface for the extra ``n``, such as ``0,-0.0995,0.995``.

    ``points`` is its outline, (n, 3) metres, not necessarily planar (Newell's method, Sutherland et al.
    1974). Raises ShapingError for points that span no surface, or an upright one.
    """
    points = np.asarray(points, dtype=np.float64)
    if not np.isfinite(points).all():
        raise ShapingError("a curve needs finite coordinates and a sagitta above 0 m; correct them")
    around_ = np.roll(points, -1, axis=0)
    x, y, z = np.cross(points - points[0], around_ - points[0]).sum(axis=0)
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0 or abs(z) < 1e-3 * length:
        raise ShapingError(
            "a ramp whose points span no surface that one can drive on has no normal; correct it"
        )
    # Adding 0 makes 0 of -0.
    return ",".join(f"{round(v / math.copysign(length, z), 4) + 0.0:g}" for v in (x, y, z))


# --- Small closed shapes for objects drawn as points: by name, or by kind and size ---

NAMED: Mapping[str, str] = MappingProxyType(
    {
        "bench": "rectangle 1.8 0.6",
        "bicycle_stand": "rectangle 0.8 0.1",
        "bollard": "circle 0.2",
        "litter_bin": "circle 0.5",
        "picnic_table": "rectangle 1.8 1.5",
        "planter": "square 1",
        "post_box": "square 0.5",
        "street_lamp": "circle 0.3",
        "tree": "circle 0.4",
    }
)
"""Street furniture with common sizes in metres; a name may be used wherever its shape may."""

_SMALLEST, _LARGEST = 0.01, 100.0
"""metres; a map is in centimetres, and objects larger than furniture have outlines of their own."""
_CORNERS = 8
_MOST_CORNERS = 64


@dataclass(frozen=True, eq=False)
class Template:
    """A shape around (0, 0): ``ring`` is (n, 2) metres, counter-clockwise, its first point repeated."""

    ring: NDArray[Any]

    def turned(self, by: float) -> Template:
        """Return the shape turned by radians to the left."""
        cos, sin = math.cos(by), math.sin(by)
        return Template(self.ring @ np.array([[cos, sin], [-sin, cos]]))

    def at(self, x: float, y: float, turned: float = 0.0) -> NDArray[Any]:
        """Return the ring, (n, 2), at (x, y), turned by radians to the left.

        Raises ShapingError for values that are not finite.
        """
        if not all(map(math.isfinite, (x, y, turned))):
            raise ShapingError("a template needs a finite place and a finite angle; correct them")
        points: NDArray[Any] = np.array([x, y]) + (self.turned(turned) if turned else self).ring
        return points


@lru_cache(maxsize=1024)
def template(text: str) -> Template:
    """Return what ``text`` names, such as ``bench``, ``circle 0.6``, ``circle 3 16`` or ``rectangle 2 0.5``.

    A circle's first number is its diameter in metres, its second one the number of corners (8 by default);
    the disc lies within the ring, so that a robot that avoids the ring avoids the object. A rectangle's
    numbers are its width along x and its depth along y. Raises ShapingError for anything else.
    """
    kind, *numbers = NAMED.get(text.strip(), text).split() or [""]
    if kind not in _KINDS:
        raise ShapingError(
            f"there is no template {text!r}; give one of {', '.join(NAMED)}, or a kind and its metres: "
            f"{', '.join(usage for usage, _ in _KINDS.values())}"
        )
    usage, made = _KINDS[kind]
    try:
        return Template(made(*map(float, numbers)))
    except (TypeError, ValueError):
        raise ShapingError(
            f"the template {text!r} is not {usage}, with {_SMALLEST} m to {_LARGEST:g} m and 3 to "
            f"{_MOST_CORNERS} corners; correct its numbers"
        ) from None


def _circle(across: float, corners: float = _CORNERS) -> NDArray[Any]:
    _check_size(across)
    if corners not in range(3, _MOST_CORNERS + 1):
        raise ValueError(corners)
    # A side faces each axis, so that four corners are a square along the axes.
    angles = math.tau * (np.arange(corners) + 0.5) / corners
    reach = across / 2 / math.cos(math.pi / corners)
    return _closed(reach * np.column_stack([np.cos(angles), np.sin(angles)]))


def _square(side: float) -> NDArray[Any]:
    return _rectangle(side, side)


def _rectangle(width: float, depth: float) -> NDArray[Any]:
    _check_size(width, depth)
    return _closed(np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (width / 2, depth / 2))


def _closed(corners: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate([corners, corners[:1]])


def _check_size(*metres: float) -> None:
    if not all(_SMALLEST <= value <= _LARGEST for value in metres):
        raise ValueError(metres)


_KINDS: Mapping[str, tuple[str, Callable[..., NDArray[Any]]]] = MappingProxyType(
    {
        "circle": ("circle ACROSS [CORNERS]", _circle),
        "square": ("square SIDE", _square),
        "rectangle": ("rectangle WIDTH DEPTH", _rectangle),
    }
)
