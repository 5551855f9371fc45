"""What the packaging tests share: the walks, the zip, and a Python that has PyQGIS but not the venv."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Collection
from pathlib import Path

import pytest
from osgeo import gdal

from tests.support.qgis import add_compiled

ROOT = Path(__file__).resolve().parents[2]
SCREEN, A4 = [800, 1280], [620, 877]
"""Pixels of pictures."""
LARGEST = 400_000
"""Bytes of a picture that goes into the repository."""


@pytest.fixture(scope="session")
def release(tmp_path_factory) -> Path:
    """The plugin's zip, built now."""
    from tools.package import build

    return build(tmp_path_factory.mktemp("release"))


@pytest.fixture(scope="session")
def unpacked(release, tmp_path_factory) -> Path:
    """A plugins folder that holds what is in the zip, and what Python has compiled of that already."""
    folder = tmp_path_factory.mktemp("plugins")
    with zipfile.ZipFile(release) as archive:
        archive.extractall(folder)
    add_compiled(folder / "fleet_supervisor")
    return folder


@pytest.fixture(scope="session")
def stock_python() -> str:
    """The Python under the virtual environment: it has PyQGIS and none of the environment's packages."""
    return str(Path(sys.base_exec_prefix) / "bin" / "python3")


@pytest.fixture
def walk(tmp_path):
    """Take a walk through the desk with what is added to the environment; return how it went."""
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    kept |= {"FLEET_WALKTHROUGH_FOLDER": str(tmp_path / "walk"), "PYTHONPATH": str(ROOT)}

    def go(name: str, **added: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "tools.walkthrough", name, "--pictures", tmp_path / "pictures"],
            env={**kept, **added},
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )

    return go


@pytest.fixture
def take_pictures(walk, tmp_path):
    """Take a walk to its end and check that it took a picture of each of its steps, of ``least`` bytes.

    Those named in ``pages`` are of sheets of paper, the others of the screen.
    """

    def go(name: str, steps: list[str], least: int, pages: Collection[str] = ()) -> None:
        done = walk(name)
        assert done.returncode == 0, done.stdout + done.stderr
        pictures = sorted((tmp_path / "pictures").iterdir())
        assert [picture.stem for picture in pictures] == [
            f"{name}-{number:02d}-{step}" for number, step in enumerate(steps, start=1)
        ]
        for picture, step in zip(pictures, steps, strict=True):
            image = gdal.Open(str(picture))
            assert sorted((image.RasterXSize, image.RasterYSize)) == (A4 if step in pages else SCREEN), step
            assert least < picture.stat().st_size <= LARGEST, picture.name

    return go
