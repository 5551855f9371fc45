"""The city that is made up for benchmarks: the same each time, with all that real data has."""

import pyogrio
import pytest
import shapely

from tools.made_up_city import CRS, City


@pytest.fixture(scope="module")
def city(tmp_path_factory):
    return City(2500).write(tmp_path_factory.mktemp("city"))


def test_the_same_numbers_make_the_same_bytes_and_another_seed_others(city, tmp_path):
    again, other = City(2500).write(tmp_path / "again"), City(2500, seed=2).write(tmp_path / "other")
    assert again.read_bytes() == city.read_bytes()
    assert other.read_bytes() != city.read_bytes()


def test_it_has_as_many_buildings_as_asked_for_with_courtyards_unknown_heights_and_faults(city):
    meta, _, wkb, (heights, levels, _) = pyogrio.raw.read(city, "buildings")
    shapes = shapely.from_wkb(wkb)
    assert len(shapes) == 2500 and meta["crs"] == CRS
    assert (shapely.get_num_interior_rings(shapes) > 0).sum() > 200
    assert 0.25 < (heights != heights).mean() < 0.35
    assert 0.05 < (levels != levels).mean() < 0.15
    assert 1 <= (~shapely.is_valid(shapes)).sum() <= 10


def test_every_layer_holds_what_it_is_for(city):
    counts = {name: pyogrio.read_info(city, layer=name)["features"] for name, _ in pyogrio.list_layers(city)}
    assert min(counts.values()) > 0
    assert list(counts) == ["buildings", "walls", "furniture", "streets", "surfaces", "keepouts"]
    _, _, _, (_, width, ways, _) = pyogrio.raw.read(city, "streets")
    assert {"yes", "-1", "no", None} == set(ways) and (width != width).any()


def test_its_middle_stands_among_buildings(city):
    x, y = City(2500).centre
    _, _, wkb, _ = pyogrio.raw.read(city, "buildings", bbox=(x - 50, y - 50, x + 50, y + 50))
    assert 16 <= len(wkb) <= 36
