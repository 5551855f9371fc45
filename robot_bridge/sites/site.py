"""A site as the gateway serves it: what is on it, and the robot maps cut from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from ..polyline import Track
from ..roads.keepouts import KeepoutIndex
from ..roads.surfaces.index import SurfaceIndex
from ..roads.surfaces.surface import Surface
from ..robotmap.builder import Window
from ..robotmap.errors import WindowError
from ..robotmap.group_texts import GroupText, group_texts, size_in_binary
from ..robotmap.index import OutlineIndex
from ..robotmap.model import PART_OF, Border, RobotMap
from ..robotmap.outlines import Outlines
from ..robotmap.text import write_text
from .features import Area, Centreline
from .fences import Fences
from .frame import SiteFrame
from .mapped.cache import SURELY_TOO_LARGE, SiteCache
from .reach import KNOWN_BEYOND
from .settings import Bounds, SiteSettings

_SMALLEST_NEAR = 20.0
"""metres; a robot sees so far by itself, whatever stands there."""


@dataclass(frozen=True)
class Site:
    """One published site; every geometry is in the site frame, in metres."""

    settings: SiteSettings
    outlines: Outlines
    centrelines: tuple[Centreline, ...]
    surfaces: tuple[Surface, ...]
    keepouts: tuple[Area, ...]
    cache: SiteCache | None = None
    """what was computed of ``outlines`` at publishing; else it is computed when it is needed first."""

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
    def bounds(self) -> Bounds:
        """The rectangle (x_min, y_min, x_max, y_max) in the site frame that robots may be sent into."""
        return self.settings.bounds

    @property
    def bounds_border(self) -> Border:
        """What the map of the whole site covers: the bounds in whole centimetres."""
        return Window.from_bounds(*self.bounds).border

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies in the site's bounds."""
        return self.bounds.contains(x, y)

    @property
    def has_index(self) -> bool:
        """Whether what maps are cut from is at hand."""
        return self.cache is not None or "_index" in self.__dict__

    def make_index(self) -> None:
        """Make what maps are cut from, which takes seconds where nothing was computed at publishing."""
        assert self._index is not None

    def whole_map(self) -> RobotMap:
        """Return the map that a robot gets after Ready: everything within the bounds (paper 1, III.A)."""
        return self._map(Window.from_bounds(*self.bounds))

    def whole_texts(self) -> Iterable[GroupText]:
        """Return the text of :meth:`whole_map` in parts, to hold little of it at once."""
        if self.cache is not None and self.cache.whole.texts is not None:
            return self.cache.whole.texts()
        return group_texts(self._index.outlines, self.bounds_border)

    def whole_head(self) -> str:
        """Return the text of :meth:`whole_map` up to its first obstacle."""
        return whole_head(self.settings)

    def is_too_large(self, most_bytes: int) -> bool:
        """Tell whether :meth:`whole_map` surely has more bytes than that in the binary format."""
        whole = None if self.cache is None else self.cache.whole
        if whole is not None and not whole.is_estimate:
            return whole.size > most_bytes
        size = size_in_binary(self._index, self.bounds_border) if whole is None else whole.size
        return size > SURELY_TOO_LARGE * most_bytes

    def whole_binary(self) -> bytes | None:
        """Return :meth:`whole_map` in the binary format where it was made at publishing."""
        whole = None if self.cache is None else self.cache.whole
        return whole.content if whole is not None and whole.head == self.whole_head() else None

    @property
    def segment_count(self) -> int:
        """How many segments all obstacles have together, about."""
        return self._index.count_near(self.bounds_border)

    def segments_around(self, x: float, y: float, area: float) -> int:
        """Return how many segments the map of a square has at most, as :meth:`map_around` makes it.

        :raises WindowError: when the three are no window.
        """
        return self._index.count_near(Window.square(x, y, area).border)

    def map_near(self, x: float, y: float, side: float, most: int) -> RobotMap:
        """Return the map of a square around (x, y), or around the nearest place of the site's bounds.

        It has ``side`` metres, or less where it would have more than about ``most`` segments.
        """
        x_min, y_min, x_max, y_max = self.bounds
        x, y = min(max(x, x_min), x_max), min(max(y, y_min), y_max)
        window = Window(x, y, side, side)
        while self._index.count_near(window.border) > most and window.width > _SMALLEST_NEAR:
            window = Window(x, y, window.width / 2, window.width / 2)
        return self._map(window)

    def map_around(self, x: float, y: float, area: float) -> RobotMap:
        """Return the answer to GetMap(x, y, A): a square of ``area`` m² centred on (x, y), site frame.

        :raises WindowError: when the three are no window (no area, NaN), or one of which nothing is known:
            the empty map of it would say that all is free there.
        """
        window = Window.square(x, y, area)
        if not self._is_near(window):
            x_min, y_min, x_max, y_max = self.bounds
            raise WindowError(
                f"no part of {area:g} m² around ({x:.2f}, {y:.2f}) is within {KNOWN_BEYOND:g} m of site "
                f"{self.name!r}, which reaches from ({x_min:.2f}, {y_min:.2f}) to "
                f"({x_max:.2f}, {y_max:.2f}); what stands there is not known"
            )
        return self._map(window)

    def _is_near(self, window: Window) -> bool:
        """Tell whether any of ``window`` is where it is known what stands."""
        x_min, y_min, x_max, y_max = self.bounds
        apart_x = abs(window.x - (x_min + x_max) / 2) - (window.width + x_max - x_min) / 2
        apart_y = abs(window.y - (y_min + y_max) / 2) - (window.height + y_max - y_min) / 2
        return max(apart_x, apart_y) <= KNOWN_BEYOND

    def _map(self, window: Window) -> RobotMap:
        return self._index.map_of(window, meta=self.map_meta(window.border))

    @cached_property
    def surface_index(self) -> SurfaceIndex:
        """What tells the road surface at a place; made when it is asked for first."""
        return SurfaceIndex(self.surfaces)

    @cached_property
    def keepout_index(self) -> KeepoutIndex:
        """What tells which places and ways come into keepouts; made when it is asked for first."""
        return KeepoutIndex([area.rings for area in self.keepouts])

    def keepout_between(self, path: Track) -> str | None:
        """Return the name of a keepout that ``path`` leads through and that holds neither end, or None."""
        number = self.keepout_index.between_ends(path) if self.keepouts else None
        return None if number is None else self.keepouts[number].label

    @cached_property
    def fences(self) -> Fences:
        """What tells which places are in keepouts and at obstacles; made when it is asked for first."""
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
    """Return the leading lines of the map of ``border`` of a site (design, section 6).

    One that leaves out some of the site says so by the rectangle of all of it.
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
