"""Frames of robots: there and back, headings too, and what is found from pairs of points."""

from __future__ import annotations

import math
import re

import pytest

from robot_bridge.core.sites.frame import SiteFrame
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.frames import FrameSettings, LinkFrame

SITE = SiteFrame("EPSG:32633", (640_000.0, 5_193_000.0), 0.3)
SHIFTED = FrameSettings(origin=(5.0, 6.0), rotation_deg=30.0)
ALL = [
    FrameSettings(),
    SHIFTED,
    FrameSettings(crs="utm"),
    FrameSettings(crs="wgs84"),
    FrameSettings(crs="EPSG:23700", origin=(430_000.0, 150_000.0), rotation_deg=-170.0),
    FrameSettings(crs="utm", origin=(640_010.0, 5_193_000.0), rotation_deg=90.0),
]


@pytest.mark.parametrize("settings", ALL, ids=lambda one: f"{one.crs}-{one.rotation_deg:g}")
@pytest.mark.parametrize("theta", [0.0, 1.0, -3.1])
def test_a_pose_goes_there_and_back(settings, theta):
    frame = LinkFrame(settings, SITE)
    x, y, back = frame.pose_to_site(*frame.pose_from_site(12.0, 34.0, theta))
    assert math.dist((x, y), (12.0, 34.0)) < 0.001
    assert abs(math.remainder(back - theta, math.tau)) < 1e-6


def test_robots_axes_are_turned_and_shifted_as_the_settings_say():
    assert LinkFrame(SHIFTED, SITE).pose_to_site(1.0, 0.0, 0.0) == pytest.approx(
        (5 + math.cos(math.pi / 6), 6.5, math.pi / 6)
    )
    # The site's x axis is 0.3 rad counter-clockwise from the zone's.
    x, y, theta = LinkFrame(FrameSettings(crs="utm"), SITE).pose_to_site(640_010.0, 5_193_000.0, 0.3)
    assert (x, y, theta) == pytest.approx((10 * math.cos(0.3), -10 * math.sin(0.3), 0.0), abs=1e-6)


def test_headings_of_wgs84_are_from_true_east():
    # Zone 33's middle is 15° east; at 16.84° the grid's north is 1.3° east of true north.
    x, y, theta = LinkFrame(FrameSettings(crs="wgs84"), SITE).pose_from_site(0.0, 0.0, -0.3)
    assert math.degrees(theta) == pytest.approx(-1.841 * math.sin(math.radians(46.88)), abs=0.01)
    assert (x, y) == pytest.approx((16.837, 46.876), abs=0.01)


def test_a_frame_is_fitted_to_pairs_and_its_residual_is_shown():
    pairs = [(0, 0, 10, 0), (10, 0, 10, 10), (10, 10, 0, 10.02)]
    frame = LinkFrame(FrameSettings(pairs=pairs), SITE)
    assert frame.to_site(5.0, 0.0) == pytest.approx((10.0, 5.0), abs=0.02)
    assert re.search(r"3 pairs: rotation 89\.94\d°.* rms, 0\.0\d\d m at pairs\[\d\]", frame.fit.text)
    larger = [(x / 2, y / 2, to_x, to_y) for x, y, to_x, to_y in pairs]
    scaled = LinkFrame(FrameSettings(pairs=larger, scale=True), SITE)
    assert scaled.fit.similarity.scale == pytest.approx(2.0, abs=0.01)
    assert scaled.to_site(2.5, 0.0) == pytest.approx((10.0, 5.0), abs=0.02)


WRONG = [
    (FrameSettings(crs="EPSG:1"), "frame.crs: The CRS 'EPSG:1' is not known"),
    (FrameSettings(crs="EPSG:4326"), "frame.crs: EPSG:4326 is in degrees"),
    (FrameSettings(crs="wgs84", rotation_deg=3.0), "mean nothing with crs = 'wgs84'"),
    (FrameSettings(pairs=[(0, 0, 1, 1)]), "frame.pairs: give two pairs or more"),
    (FrameSettings(pairs=[(0, 0, 1, 1), (0, 0, 2, 2)]), "frame.pairs: all points are in one place"),
    (FrameSettings(pairs=[(0, 0, 0, 0), (10, 0, 20, 0)]), "more than largest_residual_m = 1"),
    (FrameSettings(pairs=[(0, 0, 0, math.nan), (10, 0, 20, 0)]), "no finite number"),
]


@pytest.mark.parametrize(("settings", "reason"), WRONG)
def test_settings_of_no_frame_are_named_with_file_and_key(settings, reason):
    with pytest.raises(LinkError, match=re.escape(reason)) as refused:
        LinkFrame(settings, SITE, "links/agvs.toml")
    assert str(refused.value).startswith("links/agvs.toml: frame.")


@pytest.mark.parametrize("crs", ["wgs84", "EPSG:4326"])
@pytest.mark.parametrize("kind", ["ros2", "rosbridge", "vda5050"])
def test_robots_that_are_sent_somewhere_speak_no_degrees(tmp_path, kind, crs):
    load = pytest.importorskip(f"robot_bridge.links.{kind}.adapter").load
    file = tmp_path / "agvs.toml"
    file.write_text(f'[frame]\ncrs = "{crs}"\n[{kind}]\n', encoding="utf-8")
    with pytest.raises(LinkError, match=f"agvs.toml: frame.crs = '{crs}': these robots are sent metres"):
        load(file)
