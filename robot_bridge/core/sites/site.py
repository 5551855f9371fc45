"""A published site: read and written as a folder, and the robot maps cut from it."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CacheError, SiteError, WindowError
from ..files import StagedFiles
from ..geometry import Track
from ..messages.links import MOST_AREA_POINTS, SiteArea, SiteAreas, SiteRoad
from ..roads.network import Surface
from ..roads.surface_index import SurfaceIndex
from ..robotmap.model import PART_OF, Border, RobotMap, Window
from ..robotmap.outlines import Outlines
from ..robotmap.text_format import write_text
from ..robotmap.window_index import GroupText, OutlineIndex, group_texts, size_in_binary
from . import geopackage, site_layers
from .fences import Fences, KeepoutIndex
from .frame import Points, SiteBounds, SiteFrame
from .settings import (
    SETTINGS_FILE,
    SiteSettings,
    check_settings,
    earlier_settings,
    read_settings,
    settings_text,
)
from .settings_tables import value_text
from .site_cache import CACHE_FILE, SURELY_TOO_LARGE, CacheWriter, SiteCache, read_cache

# --- A site as served by the gateway: its content, and the robot maps cut from it ---

_SMALLEST_NEAR = 20.0
"""metres; within this range a robot's own sensors suffice."""


@dataclass(frozen=True)
class Site:
    """One published site; every geometry is in the site frame, in metres."""

    settings: SiteSettings
    outlines: Outlines
    centrelines: tuple[geopackage.Centreline, ...]
    surfaces: tuple[Surface, ...]
    keepouts: tuple[geopackage.Area, ...]
    cache: SiteCache | None = None
    """data computed from ``outlines`` at publishing; else it is computed at first use."""

    @property
    def id(self) -> str:
        """The site's id, unique among the sites of one gateway."""
        return self.settings.id

    @property
    def name(self) -> str:
        """The site's name for people."""
        return self.settings.name

    @property
    def version(self) -> int:
        """How often the site was published."""
        return self.settings.version

    @property
    def frame(self) -> SiteFrame:
        """The frame that robots speak."""
        return self.settings.frame

    @property
    def bounds(self) -> SiteBounds:
        """The rectangle (x_min, y_min, x_max, y_max) in the site frame that robots may be sent into."""
        return self.settings.bounds

    @property
    def bounds_border(self) -> Border:
        """The border of the map of the whole site: the bounds in whole centimetres."""
        return Window.from_bounds(*self.bounds).border

    def contains(self, x: float, y: float) -> bool:
        """Return whether (x, y), metres in the site frame, lies in the site's bounds."""
        return self.bounds.contains(x, y)

    @property
    def has_index(self) -> bool:
        """Whether the index that maps are cut from is loaded."""
        return self.cache is not None or "_index" in self.__dict__

    def make_index(self) -> None:
        """Make the index that maps are cut from; this takes seconds if nothing was computed at publishing."""
        assert self._index is not None

    def whole_map(self) -> RobotMap:
        """Return the map that a robot gets after Ready: everything within the bounds (paper 1, III.A)."""
        return self._map(Window.from_bounds(*self.bounds))

    def whole_texts(self) -> Iterable[GroupText]:
        """Return the text of :meth:`whole_map` in parts, to hold little in memory."""
        if self.cache is not None and self.cache.whole.texts is not None:
            return self.cache.whole.texts()
        return group_texts(self._index.outlines, self.bounds_border)

    def whole_head(self) -> str:
        """Return the text of :meth:`whole_map` up to its first obstacle."""
        return whole_head(self.settings)

    def is_too_large(self, most_bytes: int) -> bool:
        """Return whether :meth:`whole_map` surely exceeds ``most_bytes`` in the binary format."""
        whole = None if self.cache is None else self.cache.whole
        if whole is not None and not whole.is_estimate:
            return whole.size > most_bytes
        size = size_in_binary(self._index, self.bounds_border) if whole is None else whole.size
        return size > SURELY_TOO_LARGE * most_bytes

    def whole_binary(self) -> bytes | None:
        """Return :meth:`whole_map` in the binary format if it was made at publishing, else None."""
        whole = None if self.cache is None else self.cache.whole
        return whole.content if whole is not None and whole.head == self.whole_head() else None

    @property
    def segment_count(self) -> int:
        """Approximate number of segments of all obstacles."""
        return self._index.count_near(self.bounds_border)

    def segments_around(self, x: float, y: float, area: float) -> int:
        """Return an upper bound for the segments of the map that :meth:`map_around` makes.

        :raises WindowError: when the three are no window.
        """
        return self._index.count_near(Window.square(x, y, area).border)

    def map_near(self, x: float, y: float, side: float, most: int) -> RobotMap:
        """Return the map of a square around (x, y), or around the nearest place of the site's bounds.

        Its side is ``side`` metres, or less if it would have more than about ``most`` segments.
        """
        x_min, y_min, x_max, y_max = self.bounds
        x, y = min(max(x, x_min), x_max), min(max(y, y_min), y_max)
        window = Window(x, y, side, side)
        while self._index.count_near(window.border) > most and window.width > _SMALLEST_NEAR:
            window = Window(x, y, window.width / 2, window.width / 2)
        return self._map(window)

    def map_around(self, x: float, y: float, area: float) -> RobotMap:
        """Return the answer to GetMap(x, y, A): a square of ``area`` m² centred on (x, y), site frame.

        :raises WindowError: when the three are no window (no area, NaN), or one without data: its empty map
            would mean that all is free there.
        """
        window = Window.square(x, y, area)
        if not self._is_near(window):
            x_min, y_min, x_max, y_max = self.bounds
            raise WindowError(
                f"no part of {area:g} m² around ({x:.2f}, {y:.2f}) is within "
                f"{geopackage.KNOWN_BEYOND:g} m of site "
                f"{self.name!r}, which reaches from ({x_min:.2f}, {y_min:.2f}) to "
                f"({x_max:.2f}, {y_max:.2f}); what stands there is not known"
            )
        return self._map(window)

    def _is_near(self, window: Window) -> bool:
        """Return whether any part of ``window`` is in the area whose obstacles are known."""
        x_min, y_min, x_max, y_max = self.bounds
        apart_x = abs(window.x - (x_min + x_max) / 2) - (window.width + x_max - x_min) / 2
        apart_y = abs(window.y - (y_min + y_max) / 2) - (window.height + y_max - y_min) / 2
        return max(apart_x, apart_y) <= geopackage.KNOWN_BEYOND

    def _map(self, window: Window) -> RobotMap:
        return self._index.map_of(window, meta=self.map_meta(window.border))

    @cached_property
    def surface_index(self) -> SurfaceIndex:
        """The index of road surfaces; made at first use."""
        return SurfaceIndex(self.surfaces)

    @cached_property
    def keepout_index(self) -> KeepoutIndex:
        """The index of places and paths in keepouts; made at first use."""
        return KeepoutIndex([area.rings for area in self.keepouts])

    def keepout_between(self, path: Track) -> str | None:
        """Return the name of a keepout that ``path`` leads through and that holds neither end, or None."""
        number = self.keepout_index.between_ends(path) if self.keepouts else None
        return None if number is None else self.keepouts[number].label

    @cached_property
    def fences(self) -> Fences:
        """The index of places in keepouts and at obstacles; made at first use."""
        return Fences.of(self.keepouts, self.outlines, None if self.cache is None else self.cache.fenced)

    @cached_property
    def _index(self) -> OutlineIndex:
        return OutlineIndex.of(self.outlines) if self.cache is None else self.cache.index

    def map_meta(self, border: Border) -> dict[str, str]:
        """Return the leading lines of the map of ``border``: :func:`map_meta`."""
        return map_meta(self.settings, border)


def whole_head(settings: SiteSettings) -> str:
    """Return the text of the map of the whole site up to its first obstacle."""
    border = Window.from_bounds(*settings.bounds).border
    return write_text(RobotMap(border, (), map_meta(settings, border)))


def map_meta(settings: SiteSettings, border: Border) -> dict[str, str]:
    """Return the leading lines of the map of ``border`` of a site.

    A map that leaves out part of the site states the rectangle of the whole site.
    """
    frame, whole = settings.frame, Window.from_bounds(*settings.bounds).border
    part_of = {} if border.contains(whole) else {PART_OF: ",".join(f"{edge:.2f}" for edge in whole)}
    return {
        "version": str(settings.version),
        "crs": frame.crs,
        "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
        "rotation": f"{frame.rotation:.9f}",
        "id": settings.id,
        **part_of,
    }


# --- A published site on disk: a folder with ``site.toml`` and ``site.gpkg``, written atomically

log = logging.getLogger(__name__)

MANY = 50_000
"""Number of outlines whose reading from a GeoPackage takes seconds."""


def check_site(folder: Path | str) -> SiteSettings:
    """Return the settings of the site published in ``folder``, without reading its layers.

    :raises SiteError: naming the missing or wrong setting, its place, and the remedy.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise SiteError(
            f"{folder} is no folder: a published site is a folder with {SETTINGS_FILE} and "
            f"{geopackage.GEOPACKAGE_FILE}"
        )
    return read_settings(folder / SETTINGS_FILE)


def read_site(folder: Path | str) -> Site:
    """Return the site published in ``folder``.

    :raises SiteError: naming what is missing, incomplete or wrong, its place, and the remedy.
    """
    folder = Path(folder)
    settings = check_site(folder)
    file = folder / geopackage.GEOPACKAGE_FILE
    cache = _cache(folder, settings) if file.is_file() else None
    specs = (
        *(() if cache else (geopackage.OBSTACLES,)),
        geopackage.CENTRELINES,
        geopackage.SURFACES,
        geopackage.KEEPOUTS,
    )
    *obstacles, centrelines, surfaces, keepouts = geopackage.read_layers(
        file, specs, settings.crs, settings.stamp
    )
    outlines = cache.outlines if cache else site_layers.outlines_of(obstacles[0], settings.frame, str(file))
    if cache is None and len(outlines) > MANY:
        log.warning(
            "%s: %d outlines are read from %s, which takes its time and memory; publish the site again, and "
            "they are mapped from %s",
            folder,
            len(outlines),
            geopackage.GEOPACKAGE_FILE,
            CACHE_FILE,
        )
    site = Site(
        settings=settings,
        outlines=outlines,
        centrelines=site_layers.centrelines_of(centrelines, settings.frame, str(file)),
        surfaces=site_layers.surfaces_of(surfaces, settings.frame, str(file)),
        keepouts=site_layers.areas_of(keepouts, settings.frame, str(file)),
        cache=cache,
    )
    # Robots would wait for it.
    site.make_index()
    return site


def write_site_cache(folder: Path, settings: SiteSettings, text: str, obstacles: CacheWriter) -> None:
    """Write ``site.cache`` beside the ``site.gpkg`` in ``folder`` that ``obstacles`` are published in.

    ``text`` is that of ``site.toml``, which limits the size of maps. Nothing is written for obstacles that a
    gateway would refuse or read differently. Raises OSError.
    """
    largest = value_text(text, "maps", "largest_whole_bytes") or ""
    most = int(largest) if largest.isdecimal() else settings.maps.largest_whole_bytes
    publication = _publication(settings)
    obstacles.write(
        folder / CACHE_FILE, folder / geopackage.GEOPACKAGE_FILE, publication, whole_head(settings), most
    )


def cache_writer(partial: Path, frame: SiteFrame) -> CacheWriter:
    """Return the writer for the obstacles of a publication that is made in ``partial``; raises OSError.

    As a context manager it exits before ``partial`` is removed: see :meth:`.StagedFiles.enter`.
    """
    return CacheWriter(partial / "columns", frame)


def _cache(folder: Path, settings: SiteSettings) -> SiteCache | None:
    file = folder / CACHE_FILE
    if not file.is_file():
        return None
    try:
        return read_cache(file, folder / geopackage.GEOPACKAGE_FILE, _publication(settings))
    except (CacheError, OSError) as error:
        log.warning(
            "%s; the obstacles are read from %s, which takes longer", error, geopackage.GEOPACKAGE_FILE
        )
        return None


def _publication(settings: SiteSettings) -> dict[str, Any]:
    """Return the values that the columns of ``site.cache`` depend on."""
    return {
        "site": settings.stamp,
        "frame": [settings.crs, *settings.origin, settings.rotation_deg],
        "bounds": list(settings.bounds),
    }


def write_site(
    folder: Path | str,
    settings: SiteSettings,
    obstacles: Outlines,
    centrelines: Sequence[geopackage.Centreline] = (),
    surfaces: Sequence[Surface] = (),
    keepouts: Sequence[geopackage.Area] = (),
) -> None:
    """Publish a site in ``folder``: all geometry in the site frame, in metres.

    Other files in ``folder`` stay, and so do the operator's settings in ``site.toml``, see
    :func:`settings_text`. An existing publication is replaced only after the new one is complete; one
    interrupted between its two files is refused by :func:`read_site`, never read half.

    :raises SiteError: for a site that :func:`read_site` would refuse, and when the folder cannot be written.
    """
    folder = Path(folder)
    check_settings(settings, folder / SETTINGS_FILE)
    frame = settings.frame
    layers = (
        site_layers.obstacle_layer(obstacles, frame),
        site_layers.centreline_layer(centrelines, frame),
        site_layers.surface_layer(surfaces, frame),
        site_layers.area_layer(geopackage.KEEPOUTS, keepouts, frame),
    )
    for layer in layers:
        geopackage.check_features(layer, str(folder / geopackage.GEOPACKAGE_FILE))
    try:
        _write(folder, settings, layers, obstacles)
    except OSError as error:
        raise SiteError(
            f"The site cannot be published in {folder}: {error}. Check rights and free space."
        ) from error


def _write(
    folder: Path, settings: SiteSettings, layers: Sequence[geopackage.Layer], obstacles: Outlines
) -> None:
    with StagedFiles(folder) as staged:
        geopackage.write_layers(
            staged.folder / geopackage.GEOPACKAGE_FILE, layers, settings.crs, settings.stamp
        )
        cache = staged.enter(cache_writer(staged.folder, settings.frame))
        cache.add(obstacles)
        write_settings_and_cache(staged, settings, cache, earlier_settings(folder, settings.id))
        publish_staged(staged)


def write_settings_and_cache(
    staged: StagedFiles, settings: SiteSettings, cache: CacheWriter, earlier: str
) -> None:
    """Write ``site.toml`` and ``site.cache`` beside the layers in ``staged``, which ``cache`` was given.

    Tables that the operator set in the ``earlier`` text of ``site.toml`` stay. Raises OSError.
    """
    text = settings_text(settings, earlier)
    (staged.folder / SETTINGS_FILE).write_text(text, encoding="utf-8")
    write_site_cache(staged.folder, settings, text, cache)


def publish_staged(staged: StagedFiles) -> None:
    """Replace the published layers, settings and cache by those in ``staged``.

    The cache is replaced before the files that it belongs to: a gateway does not read it until they have
    changed, and one that reads between their replacements refuses the mixture.

    :raises OSError: let the block of ``staged`` end with it, so that everything is rolled back.
    """
    if (staged.folder / CACHE_FILE).is_file():
        staged.publish([CACHE_FILE, geopackage.GEOPACKAGE_FILE, SETTINGS_FILE])
    else:
        staged.publish([geopackage.GEOPACKAGE_FILE, SETTINGS_FILE], removed=[CACHE_FILE])


# --- The published sites in one folder, and which of them may follow one another on one gateway


def sibling_sites(folder: Path) -> list[str]:
    """Return the names of the folders beside ``folder`` that hold a site, itself included, sorted."""
    return sorted(file.parent.name for file in folder.resolve().parent.glob(f"*/{SETTINGS_FILE}"))


def frame_mismatch(served: SiteSettings, other: SiteSettings) -> str | None:
    """Return why ``other`` cannot replace ``served`` while commands and positions are stored, None if it
    can."""
    if (served.crs, served.origin, served.rotation_deg) == (other.crs, other.origin, other.rotation_deg):
        return None
    return (
        f"{other.id} has another frame ({frame_text(other)}) than {served.id}, and positions of the one are "
        "wrong in the other; start a gateway on it, with a database of its own"
    )


def frame_text(settings: SiteSettings) -> str:
    """Return the frame of a site in words: two texts are equal if the frames are, to a micrometre."""
    x, y = settings.origin
    return f"{settings.crs}, origin {x:.12g}, {y:.12g}, rotation {settings.rotation_deg:.12g}°"


# --- Content of a site in a box besides obstacles: keepouts, and roads with widths and speeds ---


def areas_in_box(site: Site, box: tuple[float, float, float, float]) -> SiteAreas:
    """Return the keepouts and roads that may touch ``box``: x_min, y_min, x_max, y_max, site frame.

    Closed roads and those on bridges and in tunnels are left out: a robot on the ground drives by others.

    :raises SiteError: if they have more points than one answer holds.
    """
    keepouts = [
        SiteArea(area.label, [_places(ring) for ring in area.rings])
        for area in site.keepouts
        if _touches(area.rings[0], box, 0.0)
    ]
    roads = [
        SiteRoad(_places(line.points), line.width_m, line.speed_ms)
        for line in site.centrelines
        if not line.closed and line.level == 0 and _touches(line.points, box, line.width_m / 2)
    ]
    count = sum(map(len, _lines(keepouts, roads)))
    if count > MOST_AREA_POINTS:
        raise SiteError(f"keepouts and roads have {count} points there, and {MOST_AREA_POINTS} are the most")
    return SiteAreas(site.version, keepouts, roads)


def _lines(keepouts: list[SiteArea], roads: list[SiteRoad]) -> Iterable[list[tuple[float, float]]]:
    for area in keepouts:
        yield from area.rings
    for road in roads:
        yield road.points


def _touches(points: Points, box: tuple[float, float, float, float], beside: float) -> bool:
    x_min, y_min, x_max, y_max = box
    low, high = points.min(axis=0) - beside, points.max(axis=0) + beside
    return bool(low[0] <= x_max and high[0] >= x_min and low[1] <= y_max and high[1] >= y_min)


def _places(points: Points) -> list[tuple[float, float]]:
    return [(x, y) for x, y in np.round(points, 3).tolist()]
