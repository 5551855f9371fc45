"""The two files of a Nav2 map: a PGM image and the YAML that says how to read it.

The rules are those of nav2_map_server (map_io.cpp): the darker a pixel, the more occupied; the first row of
the image is the highest; ``origin`` is the lower left corner of the lower left pixel.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .grid import Grid
from .occupancy import OCCUPIED, UNKNOWN

FREE_PIXEL, UNKNOWN_PIXEL, OCCUPIED_PIXEL = 254, 205, 0
"""What map_saver writes."""

OCCUPIED_THRESHOLD, FREE_THRESHOLD = 0.65, 0.196
"""205 is occupied by 50/255 = 0.19608: above 0.196, so unknown, and below the 0.25 that map_saver writes into
its files, which would make it free."""


def trinary_files(
    name: str, grid: Grid, cells: NDArray[Any], comments: Mapping[str, str] | None = None
) -> dict[str, bytes]:
    """Return ``name``.pgm and ``name``.yaml of occupied, free and unknown ``cells``, (rows, columns) int8.

    ``comments`` are written at the head of the YAML as ``# key value``.
    """
    pixels = np.full(cells.shape, FREE_PIXEL, dtype=np.uint8)
    pixels[cells == UNKNOWN] = UNKNOWN_PIXEL
    pixels[cells == OCCUPIED] = OCCUPIED_PIXEL
    yaml = _yaml(name, grid, "trinary", (OCCUPIED_THRESHOLD, FREE_THRESHOLD), comments or {})
    return {f"{name}.pgm": _pgm(pixels), f"{name}.yaml": yaml}


def scale_files(
    name: str, grid: Grid, cells: NDArray[Any], comments: Mapping[str, str] | None = None
) -> dict[str, bytes]:
    """Return ``name``.pgm and ``name``.yaml of ``cells``, (rows, columns) int8, each from 0 to 100."""
    pixels = np.round(255.0 * (100 - np.arange(101)) / 100.0).astype(np.uint8)[cells]
    yaml = _yaml(name, grid, "scale", (1.0, 0.0), comments or {})
    return {f"{name}.pgm": _pgm(pixels), f"{name}.yaml": yaml}


def _pgm(pixels: NDArray[Any]) -> bytes:
    rows, columns = pixels.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + pixels[::-1].tobytes()


def _yaml(
    name: str, grid: Grid, mode: str, thresholds: tuple[float, float], comments: Mapping[str, str]
) -> bytes:
    occupied, free = thresholds
    lines = [
        *(_comment(f"{key} {value}") for key, value in comments.items()),
        f"image: {_word(name + '.pgm')}",
        f"mode: {mode}",
        f"resolution: {_number(grid.resolution)}",
        f"origin: [{_number(grid.x_min)}, {_number(grid.y_min)}, 0.0]",
        "negate: 0",
        f"occupied_thresh: {occupied}",
        f"free_thresh: {free}",
    ]
    return ("\n".join(lines) + "\n").encode()


def _comment(text: str) -> str:
    """Return one line of comment; control characters are no YAML even there."""
    return "# " + "".join(letter if letter.isprintable() else " " for letter in text).strip()


def _word(text: str) -> str:
    """Return a text as a YAML scalar; in quotes, YAML reads what JSON reads."""
    plain = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./-]*", text)
    return text if plain else json.dumps(text, ensure_ascii=False).replace("\x7f", "\\x7f")


def _number(value: float) -> str:
    return np.format_float_positional(value, trim="0")
