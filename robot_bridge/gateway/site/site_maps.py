"""Maps of the site in the binary format, with accepted observations of robots."""

from __future__ import annotations

import dataclasses
import logging
import math
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import CrsError, MapBinaryError, RefusedError, RobotMapError
from ...core.geometry import Track
from ...core.messages.administration import SiteReport
from ...core.messages.records import ObservationReport
from ...core.roads.network import Surface
from ...core.roads.surface_index import NOWHERE
from ...core.robotmap.binary import encode
from ...core.robotmap.model import Border, EncodedMap, Obstacle, RobotMap, ShapeType, Window
from ...core.robotmap.outlines import OutlineRow, Outlines
from ...core.robotmap.parametric_shapes import template
from ...core.robotmap.text_format import write_obstacles
from ...core.robotmap.window_index import GroupText, OutlineIndex, merged
from ...core.sites.fences import FencedPolygons, Fences
from ...core.sites.frame import CrsTransform, GpsTransform, is_near
from ...core.sites.settings import SiteSettings
from ...core.sites.site import Site

# --- Accepted observations: new objects added to the maps, missing ones removed

log = logging.getLogger(__name__)

FIRST_ID = 1_000_000_000
"""Obstacle ids from here on are robots' observations; those of the site's own layers are below."""
_IDS_EACH = 8
"""A window cuts the ring around an object into four chains at most."""
_LARGEST_RADIUS = 50.0
"""metres; larger objects have an outline of their own."""
_ABOUT = 1.0
"""metres of tolerance for the place of a missing object."""
_SEMANTICS = "object"
_HEIGHT = 1.0
"""metres, if neither robot nor operator gave it; marked as an estimate."""


class ObservedArea(NamedTuple):
    """Area of an object: the id of its obstacle, its name, and its outline ring, (n, 2)."""

    id: int
    name: str
    ring: NDArray[np.float64]


class ObservedObjects:
    """Accepted objects, each a ring around its place; ``radius`` is the default in metres.

    :attr:`missing` are obstacles confirmed as gone: observations by the ``src`` of the obstacles that are
    left out. An obstacle at another place in another publication of the site is a different one.
    """

    def __init__(self, objects: Sequence[ObservationReport], radius: float) -> None:
        self.missing: dict[str, list[ObservationReport]] = {}
        for one in objects:
            if one.doubts is not None:
                self.missing.setdefault(one.doubts, []).append(one)
        self._rows = list(_rows([one for one in objects if one.doubts is None], radius))
        self._index = OutlineIndex.of(Outlines.from_rows(self._rows))

    def __len__(self) -> int:
        return len(self._index)

    def areas(self) -> list[ObservedArea]:
        """Return the areas of the objects, named by kind and the robot's id."""
        return [
            ObservedArea(_id(row.source), f"{_group(row.semantics)} {row.ext['id']}", row.points)
            for row in self._rows
        ]

    def texts(self, border: Border) -> list[GroupText]:
        """Return the texts of the objects in ``border``, in the order of their groups."""
        if not len(self._index):
            return []
        seen = self._numbered(self._index.map_of(Window.from_bounds(*border)).obstacles)
        return sorted(
            (GroupText(_group(one.semantics), write_obstacles([one])) for one in seen),
            key=lambda part: part.group,
        )

    def join(self, robot_map: RobotMap) -> RobotMap:
        """Return ``robot_map`` without missing obstacles, and with the objects that lie in it.

        They are grouped by kind.
        """
        if self.missing:
            there = [one for one in robot_map.obstacles if not self._is_missing(one)]
            robot_map = dataclasses.replace(robot_map, obstacles=tuple(there))
        if not len(self._index):
            return robot_map
        seen = self._numbered(self._index.map_of(Window.from_bounds(*robot_map.border)).obstacles)
        if not seen:
            return robot_map
        obstacles = sorted([*robot_map.obstacles, *seen], key=lambda obstacle: _group(obstacle.semantics))
        return dataclasses.replace(robot_map, obstacles=tuple(obstacles))

    def _is_missing(self, obstacle: Obstacle) -> bool:
        doubts = self.missing.get(obstacle.ext.get("src", ""), ())
        return any(_is_around(obstacle, one) for one in doubts)

    def _numbered(self, obstacles: Sequence[Obstacle]) -> list[Obstacle]:
        """Return ``obstacles`` with ids that are those of the observations in every window."""
        chains: Counter[str] = Counter()
        numbered = []
        for obstacle in obstacles:
            source = obstacle.ext["src"]
            id = _id(source) + chains[source]
            chains[source] += 1
            numbered.append(dataclasses.replace(obstacle, id=id))
        return numbered


def _is_around(obstacle: Obstacle, doubt: ObservationReport) -> bool:
    """Return whether an obstacle is where a robot found none: its box is about that place."""
    ends = np.concatenate([obstacle.a, obstacle.b])
    place = np.array([doubt.x, doubt.y])
    off = np.maximum(np.maximum(ends.min(axis=0) - place, place - ends.max(axis=0)), 0.0)
    return math.hypot(*off) <= (doubt.radius or 0.0) + _ABOUT


def _rows(objects: Sequence[ObservationReport], radius: float) -> Iterator[OutlineRow]:
    for seen in objects:
        try:
            yield _row(seen, radius)
        except (ValueError, TypeError, ArithmeticError) as error:
            # An object that cannot be drawn must not keep the others, and the whole map, from robots.
            log.error("observation %s is not drawn: %s", seen.observation, error)


def _row(seen: ObservationReport, radius: float) -> OutlineRow:
    across = 2 * min(_LARGEST_RADIUS, radius if seen.radius is None else seen.radius)
    ext = {"id": seen.object}
    return OutlineRow(
        points=template(f"circle {across}").at(seen.x, seen.y),
        shape_type=ShapeType.CLOSED_POLYGON,
        height=_HEIGHT if seen.height is None else seen.height,
        semantics=seen.semantics or seen.label or _SEMANTICS,
        source=f"observation:{seen.observation}",
        ext=ext if seen.height is not None else {**ext, "h": "est"},
    )


def _id(source: str) -> int:
    """Return the obstacle id of an observation; its chains have the following ids."""
    return FIRST_ID + _IDS_EACH * int(source.rpartition(":")[2])


def _group(semantics: str) -> str:
    """Return the word by which the map builder groups obstacles."""
    return semantics.partition(",")[0]


# --- The site's facts and maps for the fleet: binary, the whole map built once ---

AT_ONCE = 4000
"""segments of a map built while a robot waits for its acknowledgement: some hundredths of a second."""
QUICK = 500
"""segments of a map built in some 3 ms: another thread would hold the interpreter as long."""
STORED_AT_ONCE = 1_000_000
"""bytes of a map stored during that wait."""


class MapContent(NamedTuple):
    """The sources of maps, read at once, so that no map mixes two publications."""

    site: Site
    objects: ObservedObjects


def _encoded(drawn: MapContent) -> bytes | None:
    site, limit = drawn.site, drawn.site.settings.maps.largest_whole_bytes
    content = None if drawn.objects or drawn.objects.missing else site.whole_binary()
    if content is not None:
        return content if len(content) <= limit else None
    # The size of a small one is known sooner than an estimate.
    if site.segment_count > AT_ONCE and site.is_too_large(limit):
        return None
    try:
        content = encode(_whole(drawn))
    except MapBinaryError as error:
        log.warning("robots of site %s are sent windows, and not the whole map: %s", site.id, error)
        return None
    return content if len(content) <= limit else None


def _whole(drawn: MapContent) -> str | RobotMap:
    """Return the whole map: from its stored texts, unless some of these must be left out."""
    site, objects = drawn
    if objects.missing:
        return objects.join(site.whole_map())
    parts = merged(site.whole_texts(), objects.texts(Border(*site.bounds)))
    return "".join([site.whole_head(), *(part.text for part in parts)])


class SiteMaps:
    """Serves a published site to the fleet."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._problem: str | None = None
        self._earth = GpsTransform(site.frame)
        self._shown: tuple[list[ObservationReport], float] = [], site.settings.observations.object_radius_m
        self._drawn = MapContent(site, ObservedObjects(*self._shown))
        self._whole_map: tuple[MapContent, bytes | None] | None = None
        self._fences: tuple[MapContent, Fences] | None = None
        self._making = threading.Lock()
        self._any_crs = CrsTransform(site.frame)
        self._indexing = threading.Lock()

    def take_over(self, site: Site) -> None:
        """Serve ``site`` from now on, another publication with the same frame."""
        self._site = site
        self._drawn = MapContent(site, self._drawn.objects)

    def note_problem(self, problem: str | None) -> None:
        """Record why this gateway does not serve the site chosen for the fleet; None if it does."""
        self._problem = problem

    @property
    def site(self) -> Site:
        """The site as last published."""
        return self._site

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""
        return self._site.settings

    @property
    def report(self) -> SiteReport:
        """The facts of the site, as sent to operators."""
        site, settings = self._site, self._site.settings
        return SiteReport(
            id=site.id,
            name=site.name,
            version=site.version,
            crs=site.frame.crs,
            origin=site.frame.origin,
            rotation=site.frame.rotation,
            bounds=(site.bounds.x_min, site.bounds.y_min, site.bounds.x_max, site.bounds.y_max),
            reached_tolerance=settings.reached_tolerance_m,
            stale_after=settings.liveness.stale_after_s,
            lost_after=settings.liveness.lost_after_s,
            roads=bool(site.centrelines),
            problem=self._problem,
        )

    def contains(self, x: float, y: float) -> bool:
        """Return whether (x, y), metres in the site frame, lies on the site."""
        return self._site.contains(x, y)

    @property
    def has_keepouts(self) -> bool:
        """Return whether the site has any keepout."""
        return bool(self._site.keepouts)

    def keepouts_entered(self, tracks: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``tracks`` that enter a keepout, each with the keepout's name."""
        site = self._site
        if not site.keepouts:
            return {}
        with self._indexing:
            index = site.keepout_index
        return {track: site.keepouts[area].label for track, area in index.entered(tracks).items()}

    def keepouts_crossed(self, ways: Sequence[Track]) -> dict[int, str]:
        """Return the indices of ``ways`` that cross a keepout in which neither end lies.

        Each with that keepout's name.
        """
        site = self._site
        if not site.keepouts:
            return {}
        with self._indexing:
            found = {number: site.keepout_between(way) for number, way in enumerate(ways)}
        return {number: name for number, name in found.items() if name is not None}

    def fences(self) -> Fences:
        """Return the areas forbidden to robots: those of the publication, and accepted objects."""
        made = self.fences_at_hand()
        if made is None:
            drawn = self._drawn
            observed = FencedPolygons.of(drawn.objects.areas())
            made = dataclasses.replace(drawn.site.fences, observed=observed)
            self._fences = (drawn, made)
        return made

    def fences_at_hand(self) -> Fences | None:
        """Return what :meth:`fences` does if it is made already, else None; does not wait."""
        made = self._fences
        return None if made is None or made[0] is not self._drawn else made[1]

    def whole_map(self) -> bytes | None:
        """Return the map of the whole site in the binary format, None if that is larger than allowed.

        A large one takes long to build; concurrent callers wait for the same one.
        """
        with self._making:
            drawn, made = self._drawn, self._whole_map
            if made is None or made[0] is not drawn:
                made = self._whole_map = (drawn, _encoded(drawn))
            return made[1]

    def small_map_at_hand(self) -> EncodedMap | None:
        """Return the map of the whole site if it is small and built already; does not wait."""
        drawn, made = self._drawn, self._whole_map
        if made is None or made[0] is not drawn or made[1] is None or len(made[1]) > STORED_AT_ONCE:
            return None
        return EncodedMap(made[1], Border(*drawn.site.bounds), is_whole=True)

    def map_at_once(self, place: tuple[float, float] | None) -> EncodedMap:
        """Return the map of the whole site if small and at hand, else that of a window around ``place``.

        Without a place the middle of the site is taken. It takes some hundredths of a second at most.
        """
        drawn = self._drawn
        site = drawn.site
        if site.segment_count <= AT_ONCE:
            self.whole_map()
        if (whole := self.small_map_at_hand()) is not None:
            return whole
        x, y = place or (sum(site.bounds[::2]) / 2, sum(site.bounds[1::2]) / 2)
        part = site.map_near(x, y, site.settings.maps.window_m, AT_ONCE)
        return EncodedMap(encode(drawn.objects.join(part)), part.border, is_whole=False)

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Return whether :meth:`map_around` takes a few milliseconds at most, or refuses it as quickly."""
        site = self._site
        try:
            return site.has_index and site.segments_around(x, y, area) <= QUICK
        except RobotMapError:
            return True

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y) in the binary format.

        :raises RefusedError: when that square is smaller than the precision of a map.
        """
        drawn = self._drawn
        try:
            return encode(drawn.objects.join(drawn.site.map_around(x, y, area)))
        except RobotMapError as error:
            raise RefusedError(f"GetMap: {error}") from error

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on."""
        site = self._site
        shown = list(objects), site.settings.observations.object_radius_m
        # The map of a large site takes long to rebuild.
        if shown != self._shown:
            self._shown = shown
            self._drawn = MapContent(site, ObservedObjects(*shown))

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``, or None.

        They are metres in the site frame, or in ``crs``, x before y. Raises RefusedError for an unusable CRS.
        """
        site = self._site
        try:
            places = points if crs is None else self._any_crs.to_site(points, crs)
        except CrsError as error:
            raise RefusedError(str(error)) from error
        with self._indexing:
            index = site.surface_index
        return [None if k == NOWHERE else site.surfaces[k] for k in index.at_many(places).tolist()]

    def to_site(self, points: Sequence[tuple[float, float]], crs: str) -> list[tuple[float, float]]:
        """Return ``points`` of ``crs``, x before y, in metres in the site frame, to a tenth of a millimetre.

        Raises RefusedError for an unusable CRS, and for a point that the site's CRS cannot represent.
        """
        try:
            moved = self._any_crs.to_site(points, crs)
        except CrsError as error:
            raise RefusedError(str(error)) from error
        return [(round(x, 4), round(y, 4)) for x, y in moved.tolist()]

    def place_on_earth(
        self, lat: float, lon: float, heading: float | None
    ) -> tuple[tuple[float, float], float | None]:
        """Return (x, y) in metres and theta in radians, site frame, of a GPS position in degrees.

        ``heading`` is clockwise from true north. Raises RefusedError where the site's CRS has no such place,
        and where the two numbers look swapped.
        """
        try:
            place = self._earth.place(lat, lon)
            if not is_near(place, self._site.bounds):
                self._check_order(lat, lon)
            return place, None if heading is None else self._earth.theta(lat, lon, heading)
        except CrsError as error:
            self._check_order(lat, lon)
            raise RefusedError(f"SendGPS: {error}") from error

    def _check_order(self, lat: float, lon: float) -> None:
        if self._earth.looks_swapped(lat, lon, self._site.bounds):
            raise RefusedError(
                f"SendGPS: lat {lat:.6f}, lon {lon:.6f} is far from site {self._site.id}, and the other way "
                "round it lies there: latitude and longitude look swapped; correct it in the robot's program"
            )
