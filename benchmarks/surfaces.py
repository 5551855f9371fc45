"""The part on road surfaces: how fast they are told, and how near generated ones come to real ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pyogrio
import shapely

from benchmarks.clock import Spread, again, table
from benchmarks.page import Part, goal
from benchmarks.road_data import malta, track
from benchmarks.road_rivals import start_qgis
from benchmarks.surface_rivals import by_spatial_index, by_tree
from benchmarks.trial import size
from robot_bridge.core.roads.network import Surface
from robot_bridge.core.roads.surface_generation import generate_surfaces, polygon_of, rings_of
from robot_bridge.core.roads.surface_index import NOWHERE, SurfaceIndex, areas_of, surface_edges

BULK, SINGLE = size((1_000_000, 100_000), (20_000, 2_000))
SLOW = size(20_000, 500)
"""Places for what takes longer."""
RUNS = size(5, 2)
POLYGONS, CORNERS = size(100_000, 2_000), 12
"""of the made-up town."""

_HEAD = ["ZalaZONE university track", "against", "IoU", "m² of both", "only the first", "only the second"]

TEXT = """\
Places lie at random in the extent of the surfaces, a fresh one for each question; all contenders are asked
the same. Of {asked} answers {wrong} differ ({goal}). The town is made up: {polygons} polygons of {corners}
corners that overlap. Malta's are generated from its {malta} roads; the largest has {share:.0f} % of
their area.

### Points a second

Each contender answered {runs} times, one contender after the other; seconds are of processor time.

{speeds}

### Made ready

{built}

### Generated surfaces against real ones

{truth}
"""


def measure(data: Path) -> Part:
    """Measure on a made-up town, on Malta and on ZalaZONE's track."""
    application = start_qgis()
    roads = malta(data, size(None, 1500))
    made, seconds = again(lambda: generate_surfaces(roads), RUNS)
    town, island = Ground("made-up town", _town(POLYGONS)), Ground("Malta", made)
    speeds: dict[str, list[str]] = {}
    for ground in (town, island):
        for name, rate in ground.rates().items():
            speeds.setdefault(name, []).append(f"{rate:,.0f}".replace(",", " "))
    wrong = town.wrong + island.wrong
    built = [ground.ready for ground in (town, island)]
    text = TEXT.format(
        wrong=wrong,
        asked=town.asked + island.asked,
        goal=goal("none", wrong == 0),
        polygons=POLYGONS,
        corners=CORNERS,
        malta=len(roads),
        share=100 * island.largest_share,
        runs=RUNS,
        speeds=table(["", town.title, island.title], [[name, *rates] for name, rates in speeds.items()]),
        built=f"{table(['', 'polygons', 'edges', 'index built in'], built)}\n\n"
        f"Malta's surfaces are generated in {seconds:.1f} s.",
        truth=_truth(data),
    )
    assert application is not None
    return Part("Road surfaces", text, failed=wrong > 0)


class Ground:
    """Surfaces, their index, and how many answers of others were not the same."""

    def __init__(self, name: str, surfaces: Sequence[Surface]) -> None:
        self._surfaces = surfaces
        self._shapes = np.array([polygon_of(one.rings) for one in surfaces])
        self._index, seconds = again(lambda: SurfaceIndex(surfaces), RUNS)
        edges = int(shapely.get_num_coordinates(self._shapes).sum())
        areas = shapely.area(self._shapes)
        self.largest_share = float(areas.max() / areas.sum())
        self.title = f"{name}, {len(surfaces)} polygons"
        self.ready = [name, len(surfaces), edges, f"{seconds:.2f} s"]
        self.wrong = self.asked = 0

    def rates(self) -> dict[str, Spread]:
        """Return points a second of every contender, ours first; the others' answers are held to ours."""
        low, high = shapely.total_bounds(self._shapes).reshape(2, 2)
        places = np.random.default_rng(1).uniform(low, high, (BULK, 2))
        ours, told = self._index, self._index.at_many(places[:1000])
        areas = areas_of(surface_edges(self._surfaces), len(self._surfaces))
        rank = np.lexsort([-np.arange(len(areas)), areas]).argsort()
        tree_bulk, tree_single = by_tree(self._shapes, rank)
        spatial = by_spatial_index(self._shapes, rank)
        told, seconds = again(lambda: ours.at_many(places), RUNS)
        rates = {"surface index, bulk": _rate(BULK, seconds)}
        rates["surface index, single"] = self._single(ours.at, places[:SINGLE], told)
        rates["QgsSpatialIndex, prepared geometries, single"] = self._single(spatial, places[:SLOW], told)
        found, seconds = again(lambda: tree_bulk(places[:SINGLE]), RUNS)
        self._hold(found, told)
        rates["shapely STRtree, bulk"] = _rate(SINGLE, seconds)
        rates["shapely STRtree, single"] = self._single(tree_single, places[:SLOW], told)
        return rates

    def _single(self, query: Callable[[float, float], int], places: np.ndarray, told: np.ndarray) -> Spread:
        pairs = places.tolist()
        found, seconds = again(lambda: [query(x, y) for x, y in pairs], RUNS)
        self._hold(np.array(found), told)
        return _rate(len(pairs), seconds)

    def _hold(self, found: np.ndarray, told: np.ndarray) -> None:
        self.wrong += int((found != told[: len(found)]).sum())
        self.asked += len(found)


def _town(count: int) -> list[Surface]:
    random = np.random.default_rng(2)
    centres = random.uniform(0, 20 * np.sqrt(count), (count, 1, 2))
    turn = np.sort(random.uniform(0, 2 * np.pi, (count, CORNERS)), axis=1)
    reach = random.uniform(4, 12, (count, CORNERS))
    rings = centres + np.stack([np.cos(turn) * reach, np.sin(turn) * reach], axis=-1)
    shapes = shapely.make_valid(shapely.polygons(np.concatenate([rings, rings[:, :1]], axis=1)))
    shapes = shapely.convex_hull(shapes)
    return [Surface(rings_of(shape), "asphalt") for shape in shapes]


def _truth(data: Path) -> str:
    """Return how far generated and real surfaces of ZalaZONE's track are the same, and the drive on them."""
    zalazone = data / "zalazone"
    _, _, wkb, (kinds,) = pyogrio.raw.read(
        zalazone / "university_track_surfaces_derived_utm33.gpkg", columns=["surface"]
    )
    drawn = dict.fromkeys(kinds.tolist())
    for kind in drawn:
        drawn[kind] = shapely.union_all(shapely.from_wkb(wkb[kinds == kind]))
    digitised = shapely.union_all(list(drawn.values()))
    parking = [
        Surface(rings_of(part), "parking pavement") for part in shapely.get_parts(drawn["parking_pavement"])
    ]
    lanes_file = zalazone / "zalazone_lanelets_utm33.gpkg"
    _, _, wkb, _ = pyogrio.raw.read(lanes_file, layer="lanes", where="module = 'university_track'")
    lanes = shapely.union_all(shapely.from_wkb(wkb))
    roads = track(data)
    alone, with_parking = generate_surfaces(roads), [*parking, *generate_surfaces(roads, parking)]
    rows = [
        ["generated from the centrelines", "digitised from the photo", *_overlap(alone, digitised)],
        ["the same and the parking by hand", "digitised from the photo", *_overlap(with_parking, digitised)],
        ["generated from the centrelines", "the lanes' own outlines", *_overlap(alone, lanes)],
    ]
    drive = np.genfromtxt(zalazone / "uni_track_drive_utm33.csv", delimiter=",", names=True)
    places = np.column_stack([drive["x_utm33"], drive["y_utm33"]])
    on_made, on_digitised = (
        100 * float((SurfaceIndex(surfaces).at_many(places) != NOWHERE).mean())
        for surfaces in (alone, [Surface(rings_of(part), "") for part in shapely.get_parts(digitised)])
    )
    told = (
        f"Of the {len(places)} poses of a real drive {on_made:.1f} % lie on the generated surfaces and "
        f"{on_digitised:.1f} % on the digitised ones."
    )
    return f"{table(_HEAD, rows)}\n\n{told}"


def _overlap(surfaces: Sequence[Surface], truth: shapely.Geometry) -> list[str]:
    whole = shapely.union_all([polygon_of(one.rings) for one in surfaces])
    both = whole.intersection(truth).area
    union = whole.area + truth.area - both
    return [f"{both / union:.3f}", f"{both:.0f}", f"{whole.area - both:.0f}", f"{truth.area - both:.0f}"]


def _rate(count: int, seconds: Spread) -> Spread:
    """Return how many a second ``count`` of them come to: the longest time is the lowest rate."""
    return Spread(count / seconds.median, count / seconds.high, count / seconds.low)
