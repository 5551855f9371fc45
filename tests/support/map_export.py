"""Exports the sample site's robot map with a real qgis_process, as a script would, and reads it back."""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robot_bridge.core.robotmap.binary import decode_text
from robot_bridge.core.robotmap.text_format import read_text
from robot_bridge.core.sites.site import read_site
from tests.support.errors import StageError
from tests.support.fleet import PROJECT, SITE
from tests.support.qgis import Profile, program

LAYERS = ("Buildings", "Walls", "Columns", "Litter bins", "Benches", "Stairs")
TIMEOUT_S = 120
FORMATS = ("text", "binary")


@dataclass(frozen=True)
class ExportedMap:
    """What the two files hold. ``area`` is that of the window, m²; sizes are bytes."""

    obstacles: int
    segments: int
    area: float
    text_bytes: int
    binary_bytes: int


def export(profile: Profile, text: Path, binary: Path) -> ExportedMap:
    """Write the whole sample site as ``text`` and as ``binary``; both must hold the same map.

    :raises StageError: when the algorithm fails, or what it wrote is empty or cannot be read back.
    """
    for path, format_name in zip((text, binary), FORMATS, strict=True):
        path.unlink(missing_ok=True)
        _run(profile, path, format_name)
    written = text.read_text(encoding="utf-8")
    if decode_text(binary.read_bytes()) != written:
        raise StageError(f"{binary} does not hold the same map as {text}")
    robot_map = read_text(written)
    if not robot_map.obstacles:
        raise StageError(f"{text} holds no obstacle")
    if not np.allclose(robot_map.border, read_site(SITE).bounds, atol=0.01):
        raise StageError(f"{text} covers {robot_map.border}, not the site's bounds {read_site(SITE).bounds}")
    return ExportedMap(
        obstacles=len(robot_map.obstacles),
        segments=robot_map.segment_count,
        area=robot_map.border.area,
        text_bytes=text.stat().st_size,
        binary_bytes=binary.stat().st_size,
    )


def _run(profile: Profile, output: Path, format_name: str) -> None:
    done = subprocess.run(
        [program("qgis_process"), "run", "fleet:exportrobotmap", *_arguments(output, format_name)],
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", **profile.environment(packages=True)},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    if done.returncode != 0 or not output.is_file():
        said = re.sub(r"\n{2,}", "\n", done.stdout + done.stderr)[-1500:]
        raise StageError(f"qgis_process wrote no {output} (status {done.returncode}); it said:\n{said}")


def _arguments(output: Path, format_name: str) -> list[str]:
    site = read_site(SITE)
    x_min, y_min, x_max, y_max = site.bounds
    ((east, north),) = site.frame.to_crs(np.array([[(x_min + x_max) / 2, (y_min + y_max) / 2]]))
    return [
        f"--PROJECT_PATH={PROJECT}",
        "--",
        *(f"OBSTACLES={layer}" for layer in LAYERS),
        f"CENTER={east:.3f},{north:.3f} [{site.frame.crs}]",
        f"WIDTH={x_max - x_min}",
        f"HEIGHT={y_max - y_min}",
        f"FORMAT={format_name}",
        f"OUTPUT={output}",
    ]
