"""The script that makes the sample site: twice the same, and the same as what lies beside it."""

import shutil
import subprocess
import sys

import pytest
from qgis.core import Qgis

from robot_bridge.core.sites.site import read_site

RANDOM_ELEVATION_COLOURS = 32600
"""from this QGIS on, a project holds symbols for elevation, and QGIS draws their colours by lot."""


@pytest.fixture(scope="module")
def workshop(root, sample_site, tmp_path_factory):
    """A copy of the script in a tree of its own, where it has run once."""
    tree = tmp_path_factory.mktemp("workshop")
    (tree / "robot_bridge").symlink_to(root / "robot_bridge")
    folder = tree / "resources" / "sample_site"
    shutil.copytree(
        sample_site, folder, ignore=shutil.ignore_patterns("*.gpkg", "*.tif", "*.qgz", "site.toml")
    )
    shutil.copytree(root / "resources" / "styles", tree / "resources" / "styles")
    shutil.copy(sample_site / "orthophoto.tif", folder)
    make(folder)
    return folder


def make(folder):
    command = [sys.executable, str(folder / "make_sample_site.py"), "layers", "project"]
    subprocess.run(command, check=True, timeout=240)


def test_two_runs_give_the_same_bytes(workshop):
    names = ["sample_site.gpkg", "site.gpkg", "site.toml"]
    if Qgis.QGIS_VERSION_INT < RANDOM_ELEVATION_COLOURS:
        names.append("sample_site.qgz")
    before = {name: (workshop / name).read_bytes() for name in names}
    make(workshop)
    assert {name: (workshop / name).read_bytes() for name in names} == before


def test_the_repository_holds_what_the_script_makes(workshop, sample_site):
    made, kept = read_site(workshop), read_site(sample_site)
    assert made.settings == kept.settings
    assert made.outlines.coordinates.tolist() == kept.outlines.coordinates.tolist()
    assert list(made.outlines.semantics) == list(kept.outlines.semantics)
    assert made.outlines.ext == kept.outlines.ext
    assert [road.points.tolist() for road in made.centrelines] == [
        road.points.tolist() for road in kept.centrelines
    ]
    assert [len(area.rings) for area in made.surfaces] == [len(area.rings) for area in kept.surfaces]
