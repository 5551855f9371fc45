"""A sample of the windows that `make bench` holds against shapely, and what the check would notice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.correctness import City, faults

CITIES = {
    "helsinki": ("helsinki_centre_utm35n.gpkg", (385944.0, 6672300.0)),
    "malta": ("malta_2018_utm33n.gpkg", (450000.0, 3970000.0)),
}


@pytest.fixture(scope="module", params=CITIES)
def city(request, data):
    file, origin = CITIES[request.param]
    return City.read(data / "osm" / file, request.param, origin)


def test_windows_of_a_real_city_are_what_shapely_cuts(city):
    found = {window: wrong for window in city.windows(25, seed=2) if (wrong := faults(city, window))}
    assert not found
    assert sum(city.index.map_of(window).segment_count for window in city.windows(25, seed=2)) > 300


class Spoilt:
    """An index whose maps have been changed."""

    def __init__(self, index, change):
        self._index, self._change = index, change

    def map_of(self, window):
        robot_map = self._index.map_of(window)
        obstacles = [self._change(robot_map.border, o) for o in robot_map.obstacles]
        return replace(robot_map, obstacles=tuple(o for o in obstacles if o is not None))


def turned(border, obstacle):
    return replace(obstacle, a=obstacle.b, b=obstacle.a)


def shifted(border, obstacle):
    return replace(obstacle, a=obstacle.a + 0.03, b=obstacle.b + 0.03)


def walled(border, obstacle):
    corners = np.array([(border.x_min, border.y_min), (border.x_max, border.y_min)])
    return replace(obstacle, a=np.vstack([obstacle.a, corners[:1]]), b=np.vstack([obstacle.b, corners[1:]]))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (turned, "inside on the right"),
        (shifted, "in the map is no obstacle"),
        (walled, "along the border that is none"),
        (lambda border, obstacle: None, "is not in the map"),
    ],
)
def test_the_check_notices_a_map_that_is_wrong(city, change, said):
    spoilt = replace(city, index=Spoilt(city.index, change))
    window = max(city.windows(25, seed=2), key=lambda w: city.index.map_of(w).segment_count)
    assert any(said in fault for fault in faults(spoilt, window))
