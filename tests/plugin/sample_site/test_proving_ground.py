"""The site of the real proving ground: made by its script, read by the bridge, opened by QGIS."""

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely

from robot_bridge.core.sites.site import read_site


@pytest.fixture(scope="module")
def made(root, data, tmp_path_factory):
    """The folder that the script has filled."""
    out = tmp_path_factory.mktemp("proving_ground")
    command = [sys.executable, "-m", "tools.proving_ground", str(out), str(data)]
    subprocess.run(command, check=True, timeout=240, cwd=root)
    return out


@pytest.fixture(scope="module")
def drive(data, made):
    """(n, 2) places of the real drive on that track, in the site frame."""
    with (data / "zalazone" / "uni_track_drive_utm33.csv").open() as file:
        rows = [(float(row["x_utm33"]), float(row["y_utm33"])) for row in csv.DictReader(file)]
    return read_site(made).frame.to_site(rows)


def test_the_published_track_has_110_lanes_with_widths(made):
    site = read_site(made)
    assert len(site.centrelines) == 110
    widths = sorted(road.width_m for road in site.centrelines)
    assert widths[0] == 3.44
    assert widths[-2] < 9.0, "all but the one lane across the dynamic platform"
    assert {area.label for area in site.surfaces} == {"asphalt", "parking pavement"}


def test_lane_borders_are_no_obstacles(made):
    assert read_site(made).whole_map().obstacles == ()


def test_the_real_drive_stayed_on_the_published_surfaces(made, drive):
    site = read_site(made)
    surfaces = shapely.union_all([shapely.Polygon(area.rings[0], area.rings[1:]) for area in site.surfaces])
    assert np.mean(shapely.contains_xy(surfaces, drive)) > 0.95
    assert np.mean(shapely.contains_xy(surfaces, drive + np.array([15.0, 0.0]))) < 0.7
    assert all(site.contains(x, y) for x, y in drive)


def test_the_project_opens_with_every_layer_and_its_role(made, data, opened):
    project, complaints = opened(made / "proving_ground.qgz")
    layers = {layer.name(): layer for layer in project.mapLayers().values()}
    assert {name: layer.customProperty("fleet/role") for name, layer in layers.items()} == {
        "Drone photo": "orthophoto",
        "Road surfaces": "road_surface",
        "Road centrelines": "road_centreline",
        "Keepouts": "keepout",
    }
    assert all(layer.isValid() for layer in layers.values())
    assert layers["Road centrelines"].featureCount() == 110
    photo = Path(layers["Drone photo"].source())
    assert photo.is_relative_to(data.resolve()), "the photo stays where it lies"
    assert project.readEntry("fleet", "site")[0] == "."
    assert project.crs().authid() == "EPSG:32633"
    variables, frame = project.customVariables(), read_site(made).frame
    assert (float(variables["fleet_origin_x"]), float(variables["fleet_origin_y"])) == frame.origin
    assert variables["fleet_site_crs"] == frame.crs
    assert complaints == []


def test_the_photo_shows_asphalt_under_the_centrelines(made, opened, drawn):
    project, _ = opened(made / "proving_ground.qgz")
    (photo,) = project.mapLayersByName("Drone photo")
    pixels = drawn(project, [photo], width=921, height=1016)
    site = read_site(made)
    middles = np.concatenate([road.points for road in site.centrelines])

    def green(points):
        columns = (points[:, 0] / 0.35).astype(int).clip(0, 920)
        rows = ((site.bounds.y_max - points[:, 1]) / 0.35).astype(int).clip(0, 1015)
        red, grass, blue = pixels[rows, columns].T
        return np.mean(grass > np.maximum(red, blue) + 8)

    assert green(middles) < 0.03
    assert green(middles + np.array([12.0, 12.0])) > 0.2


def test_the_project_is_drawn_with_surfaces_over_the_photo(made, opened, drawn):
    project, _ = opened(made / "proving_ground.qgz")
    layers = project.layerTreeRoot().layerOrder()
    whole = drawn(project)
    for name in ("Drone photo", "Road surfaces", "Road centrelines"):
        without = drawn(project, [layer for layer in layers if layer.name() != name])
        assert np.abs(whole - without).max() > 20, name


def test_missing_data_is_named(root, tmp_path):
    run = subprocess.run(
        [sys.executable, "-m", "tools.proving_ground", str(tmp_path / "out"), str(tmp_path)],
        capture_output=True,
        text=True,
        cwd=root,
    )
    assert run.returncode == 1
    assert "university_track_centrelines.geojson is missing: give the folder of real data" in run.stderr
    assert "Traceback" not in run.stderr
