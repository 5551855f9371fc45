"""The sample site's plan: every object with its place, in the site frame, metres. Invented, not surveyed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
import shapely.ops
from roads_plan import Road, campus_roads, handling_course, paved_ways, surfaces

SITE_ID, SITE_NAME = "sample", "Sample proving ground and campus"
CRS, ORIGIN = "EPSG:32633", (640420.0, 5193480.0)
WIDTH, HEIGHT = 200.0, 160.0
HALL = (128.0, 104.0, 172.0, 135.0)
HALL_CORNER = 6.0
HALL_LOOP_OFFSET = 2.2
TERRACE_HEIGHT = 1.05


@dataclass(frozen=True)
class Item:
    """One object: its geometry, name, height in metres above the ground, and what it is made of or like."""

    geometry: shapely.Geometry
    name: str
    height: float
    kind: str


@dataclass(frozen=True)
class Ramp:
    """A ramp: its outline, rise and run in metres, and the direction of ascent in degrees from the x axis."""

    item: Item
    rise: float
    run: float
    up_deg: float

    @property
    def slope(self) -> shapely.Polygon:
        """The outline in 3D: metres above the foot of the ramp."""
        up = np.array([math.cos(math.radians(self.up_deg)), math.sin(math.radians(self.up_deg))])
        outline = shapely.get_coordinates(self.item.geometry)
        along = outline @ up
        z = self.rise * (along - along.min()) / self.run
        return shapely.Polygon(np.column_stack([outline, np.round(z, 3)]))


@dataclass(frozen=True)
class Plan:
    """Everything on the sample site."""

    roads: list[Road]
    surfaces: dict[str, shapely.Geometry]
    buildings: list[Item]
    walls: list[Item]
    columns: list[Item]
    litter_bins: list[Item]
    benches: list[Item]
    stairs: list[Item]
    ramps: list[Ramp]
    keepouts: list[Item]


def make_plan() -> Plan:
    """Return the plan of the sample site."""
    hall = hall_outline()
    loop = shapely.Polygon(hall).buffer(HALL_LOOP_OFFSET, join_style="mitre").exterior
    roads = handling_course() + campus_roads() + paved_ways(np.array(loop.coords))
    return Plan(
        roads=roads,
        surfaces=surfaces(roads),
        buildings=buildings(hall),
        walls=walls(),
        columns=columns(),
        litter_bins=litter_bins(),
        benches=benches(),
        stairs=[stairs()],
        ramps=[ramp()],
        keepouts=keepouts(),
    )


def hall_outline() -> list[tuple[float, float]]:
    """Return the hall's outline, 44 m × 31 m with cut corners: the loop around it is about 150 m long."""
    x0, y0, x1, y1 = HALL
    c = HALL_CORNER
    return [
        (x0 + c, y0), (x1 - c, y0), (x1, y0 + c), (x1, y1 - c),
        (x1 - c, y1), (x0 + c, y1), (x0, y1 - c), (x0, y0 + c),
    ]  # fmt: skip


def buildings(hall: list[tuple[float, float]]) -> list[Item]:
    court = shapely.box(141, 114, 159, 125)
    canteen = [(182, 102), (195, 102), (195, 134), (188, 134), (188, 116), (182, 116)]
    return [
        Item(shapely.Polygon(hall).difference(court), "Hall A", 11.0, "flat"),
        Item(shapely.box(84, 93, 112, 110), "Workshop", 7.0, "metal"),
        Item(shapely.box(84, 128, 112, 142), "Library", 8.5, "pitched"),
        Item(shapely.box(122, 66, 130, 74), "Control tower", 14.0, "tower"),
        Item(shapely.Polygon(canteen), "Canteen", 4.8, "green"),
        Item(shapely.box(150, 18, 188, 34), "Offices", 7.5, "solar"),
        Item(shapely.box(134, 10, 141, 15), "Cone store", 2.8, "metal"),
    ]


def walls() -> list[Item]:
    """Return free-standing walls as lines: noise barrier, car park, garden and terrace."""
    lines = [
        ("Noise barrier", 3.0, "concrete", [(145, 4), (145, 38)]),
        ("Car park wall", 2.0, "brick", [(73.2, 92.5), (73.2, 129.5), (52, 129.5 + 2)]),
        ("Garden wall", 1.8, "brick", [(114.5, 127), (114.5, 143), (98, 143 + 1.5)]),
        ("Terrace wall west", TERRACE_HEIGHT, "concrete", [(152, 34), (152, 39), (160, 39)]),
        ("Terrace wall middle", TERRACE_HEIGHT, "concrete", [(166, 39), (168, 39), (168, 41), (184, 41)]),
        ("Terrace wall east", TERRACE_HEIGHT, "concrete", [(171.4, 39), (186, 39), (186, 34)]),
    ]
    return [Item(shapely.LineString(points), name, height, kind) for name, height, kind, points in lines]


def columns() -> list[Item]:
    """Return round columns: eight of a colonnade on the plaza, two at the hall's entrance way."""
    places = [(152 + 5 * k, 50.0) for k in range(8)] + [(147.2, 96.0), (152.8, 96.0)]
    return [
        Item(shapely.Point(x, y).buffer(0.35, quad_segs=4), f"C{k}", 4.0, "round")
        for k, (x, y) in enumerate(places, start=1)
    ]


def litter_bins() -> list[Item]:
    places = [
        (148.6, 57.3), (169.0, 57.3), (187.4, 57.3), (147.6, 88.2), (152.4, 100.2), (176.2, 100.0),
        (176.2, 121.8), (123.6, 116.4), (81.2, 112.4), (72.0, 110.9), (35.6, 91.6), (7.2, 111.0),
        (134.4, 62.6), (132.0, 76.5),
    ]  # fmt: skip
    return [
        Item(shapely.box(x - 0.25, y - 0.25, x + 0.25, y + 0.25), f"B{k}", 1.0, "metal")
        for k, (x, y) in enumerate(places, start=1)
    ]


def benches() -> list[Item]:
    places = [
        (154.5, 53.2),
        (159.5, 53.2),
        (174.5, 53.2),
        (179.5, 53.2),
        (156.0, 66.4),
        (168.0, 66.4),
        (180.0, 66.4),
    ]
    return [
        Item(shapely.box(x - 1.0, y - 0.25, x + 1.0, y + 0.25), f"Bench {k}", 0.45, "wood")
        for k, (x, y) in enumerate(places, start=1)
    ]


def stairs() -> Item:
    """Return the terrace stairs, one line a riser, bottom first, left to right as one walks up (south)."""
    count, tread = 7, 0.30
    risers = [
        [(166.0, 39.0 + (count - k) * tread), (160.0, 39.0 + (count - k) * tread)] for k in range(count + 1)
    ]
    return Item(shapely.MultiLineString(risers), "Terrace stairs", TERRACE_HEIGHT / count, "concrete")


def ramp() -> Ramp:
    """Return the terrace ramp, 1:12, which climbs towards the west."""
    outline = shapely.box(171.4, 39.0, 184.0, 41.0)
    return Ramp(Item(outline, "Terrace ramp", 0.0, "concrete"), TERRACE_HEIGHT, 12.6, 180.0)


def keepouts() -> list[Item]:
    angles = np.linspace(0, 2 * math.pi, 40, endpoint=False)
    basin = [(66 + 9.5 * math.cos(a), 32.2 + 3.1 * math.sin(a) + 0.4 * math.sin(3 * a)) for a in angles]
    dig = [(86, 145.5), (97, 146.0), (104, 149.5), (101, 155.5), (90, 156.0), (84, 151)]
    return [
        Item(shapely.Polygon(basin), "Water basin", 0.0, "water"),
        Item(shapely.Polygon(dig), "Excavation", 0.0, "soil"),
    ]
