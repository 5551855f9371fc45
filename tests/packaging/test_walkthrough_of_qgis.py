"""A walk through what the plugin adds to QGIS itself, by mouse and keyboard, in QGIS's dark theme."""

from __future__ import annotations

from osgeo import gdal

STEPS = [
    "site",
    "options",
    "connection",
    "locator",
    "coordinates",
    "stopped",
    "identify",
    "table",
    "expression",
    "labels",
]
LARGEST = 400_000
"""Bytes of a picture that goes into the repository."""


def test_each_step_happens_on_the_screen_and_at_the_gateway_and_nothing_is_cut_off(walk, tmp_path):
    done = walk("qgis")
    assert done.returncode == 0, done.stdout + done.stderr
    pictures = sorted((tmp_path / "pictures").iterdir())
    assert [picture.stem for picture in pictures] == [
        f"qgis-{number:02d}-{step}" for number, step in enumerate(STEPS, start=1)
    ]
    for picture in pictures:
        image = gdal.Open(str(picture))
        assert (image.RasterXSize, image.RasterYSize) == (1280, 800)
        assert 30_000 < picture.stat().st_size <= LARGEST, picture.name
