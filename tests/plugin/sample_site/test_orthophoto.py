"""The sample site's orthophoto: its size on the ground and on disk, and that it shows the site's geometry."""

import numpy as np
import pytest
import shapely
from osgeo import gdal

from robot_bridge.core.sites.site import read_site


@pytest.fixture
def photo(sample_site):
    return gdal.Open(str(sample_site / "orthophoto.tif"))


def test_a_pixel_is_5_to_10_cm_in_utm_33(photo):
    _, width, skew, _, skew2, height = photo.GetGeoTransform()
    assert 0.05 <= width <= 0.10
    assert (height, skew, skew2) == (-width, 0.0, 0.0)
    assert photo.GetSpatialRef().GetAuthorityCode(None) == "32633"


def test_the_photo_covers_the_bounds_of_the_site(photo, sample_site):
    bounds, origin = read_site(sample_site).bounds, read_site(sample_site).frame.origin
    x, step, _, y, _, _ = photo.GetGeoTransform()
    assert (x, y - step * photo.RasterYSize) == pytest.approx(origin)
    assert photo.RasterXSize * step == pytest.approx(bounds.x_max - bounds.x_min)
    assert photo.RasterYSize * step == pytest.approx(bounds.y_max - bounds.y_min)


def test_the_photo_is_tiled_jpeg_with_overviews_under_4_mb(photo, sample_site):
    assert photo.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") == "YCbCr JPEG"
    assert photo.GetRasterBand(1).GetBlockSize() == [256, 256]
    assert photo.GetRasterBand(1).GetOverviewCount() >= 3
    assert (sample_site / "orthophoto.tif").stat().st_size < 4_000_000
    assert not (sample_site / "orthophoto.tif.ovr").exists()


def test_roads_are_grey_and_the_meadow_is_green_where_the_layers_say(photo, sample_site):
    site = read_site(sample_site)
    pixels = photo.ReadAsArray().astype(float)

    def colours(points):
        columns = (points[:, 0] / 0.08).astype(int)
        rows = ((site.bounds.y_max - points[:, 1]) / 0.08).astype(int)
        return pixels[:, rows.clip(0, 1999), columns.clip(0, 2499)]

    asphalt = [area for area in site.surfaces if area.label == "asphalt"]
    road = shapely.union_all([shapely.Polygon(area.rings[0], area.rings[1:]) for area in asphalt])
    rng = np.random.default_rng(1)
    xy = rng.uniform((1, 1), (199, 75), (6000, 2))
    inside = shapely.contains_xy(road.buffer(-0.7), xy)
    infield = shapely.contains_xy(shapely.box(45, 52, 70, 58), xy)
    colourful = np.ptp(colours(xy), axis=0)
    assert np.mean(colourful[inside] < 20) > 0.9
    assert np.mean(colourful[infield] > 25) > 0.9


def test_the_photo_has_the_contrast_of_a_photo(photo):
    light = photo.ReadAsArray().mean(axis=0)
    assert light.std() > 25
    assert np.percentile(light, 1) < 60
    assert np.percentile(light, 99) > 170
