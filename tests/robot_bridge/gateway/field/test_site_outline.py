"""What the field page is told of a site: places on the earth, and no more of them than a phone can take."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from robot_bridge.core.errors import CrsError
from robot_bridge.core.sites.frame import SiteBounds, SiteFrame, lonlat_of
from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway.field import page as module
from robot_bridge.gateway.field.page import earth_polynomial, site_outline


def evaluate(polynomial, places):
    """Compute the polynomials as the browser does: term by term."""
    u = (places - polynomial.centre) / polynomial.scale
    powers = [(i, j) for i in range(4) for j in range(4 - i)]
    terms = [u[:, 0] ** i * u[:, 1] ** j for i, j in powers]
    rows = (polynomial.lon, polynomial.lat)
    return np.column_stack([sum(c * term for c, term in zip(row, terms, strict=True)) for row in rows])


@pytest.mark.parametrize(
    ("crs", "origin", "side"),
    [
        ("EPSG:32633", (640420.0, 5193480.0), 200.0),
        ("EPSG:23700", (460000.0, 190000.0), 5_000.0),
        ("EPSG:25831", (430000.0, 4580000.0), 30_000.0),
        ("EPSG:3857", (1875000.0, 5922000.0), 10_000.0),
    ],
)
@pytest.mark.parametrize("rotation", [0.0, 33.0])
def test_a_browser_places_robots_within_a_centimetre(crs, origin, side, rotation):
    frame = SiteFrame(crs, origin, math.radians(rotation))
    polynomial = earth_polynomial(frame, SiteBounds(0.0, -side / 4, side, side / 2))
    places = np.random.default_rng(7).uniform([0, -side / 4], [side, side / 2], (500, 2))
    right, computed = lonlat_of(frame)(places), evaluate(polynomial, places)
    latitude = math.radians(right[:, 1].mean())
    off = np.hypot((computed - right)[:, 0] * math.cos(latitude), (computed - right)[:, 1]) * 111_320
    assert off.max() < 0.01
    assert off.max() <= polynomial.within_m * 1.01 + 1e-6


def test_the_sample_site_is_there_whole(sample_site):
    site = read_site(sample_site)
    outline = site_outline(site)
    assert outline["left_out"] == []
    assert len(outline["roads"]) == len(site.centrelines) and len(outline["surfaces"]) == len(site.surfaces)
    assert [one["name"] for one in outline["keepouts"]] == [area.label for area in site.keepouts]
    assert len(outline["obstacles"]) == len(site.outlines)
    (lon, lat), *_ = outline["bounds"]
    assert (lon, lat) == pytest.approx(tuple(lonlat_of(site.frame)(np.zeros((1, 2)))[0]), abs=1e-7)


def test_what_is_too_much_is_left_out_and_named_keepouts_last(sample_site, monkeypatch):
    site = read_site(sample_site)
    keepouts = sum(len(ring) for area in site.keepouts for ring in area.rings)
    monkeypatch.setattr(module, "MOST_POINTS", keepouts + 3)
    outline = site_outline(site)
    assert len(outline["keepouts"]) == len(site.keepouts)
    assert outline["left_out"] == ["roads", "surfaces", "obstacles"]


def test_a_site_that_is_nowhere_on_the_earth_says_so(sample_site):
    site = read_site(sample_site)
    local = 'LOCAL_CS["hall",UNIT["metre",1]]'
    nowhere = dataclasses.replace(site, settings=dataclasses.replace(site.settings, crs=local))
    with pytest.raises(CrsError):
        site_outline(nowhere)
