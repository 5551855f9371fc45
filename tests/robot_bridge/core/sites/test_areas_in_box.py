"""What adapters are told of a site's keepouts and roads, on the sample site."""

import dataclasses

import pytest

from robot_bridge.core.errors import SiteError
from robot_bridge.core.sites import site as module
from robot_bridge.core.sites.site import areas_in_box, read_site

ALL = (0.0, 0.0, 200.0, 160.0)


@pytest.fixture(scope="module")
def site(root):
    return read_site(root / "resources" / "sample_site")


def test_all_keepouts_and_open_roads_are_on_the_whole_site(site):
    found = areas_in_box(site, ALL)
    assert [area.name for area in found.keepouts] == ["Water basin", "Excavation"]
    assert len(found.roads) == sum(not line.closed and line.level == 0 for line in site.centrelines)
    assert found.version == site.version


def test_a_box_has_what_touches_it(site):
    assert [area.name for area in areas_in_box(site, (80.0, 140.0, 90.0, 150.0)).keepouts] == ["Excavation"]
    # The road along y = 8 m is 8 m wide.
    assert areas_in_box(site, (50.0, 11.9, 60.0, 12.1)).roads
    assert not areas_in_box(site, (50.0, 12.1, 60.0, 12.2)).roads


@pytest.mark.parametrize("changed", [{"closed": True}, {"level": 1}, {"level": -1}])
def test_roads_that_nobody_drives_on_there_are_left_out(site, changed):
    other = dataclasses.replace(
        site, centrelines=tuple(dataclasses.replace(line, **changed) for line in site.centrelines)
    )
    assert areas_in_box(other, ALL).roads == []


def test_more_than_an_answer_holds_is_refused(site, monkeypatch):
    monkeypatch.setattr(module, "MOST_AREA_POINTS", 100)
    with pytest.raises(SiteError, match="points there, and 100 are the most"):
        areas_in_box(site, ALL)
