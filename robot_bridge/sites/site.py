"""A site as the gateway serves it: what is on it, and the robot maps cut from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ..roads.keepouts import KeepoutIndex
from ..roads.surfaces.index import SurfaceIndex
from ..roads.surfaces.surface import Surface
from ..robotmap.builder import Window
from ..robotmap.errors import WindowError
from ..robotmap.index import OutlineIndex
from ..robotmap.model import RobotMap
from ..robotmap.outlines import Outlines
from .features import Area, Centreline
from .frame import SiteFrame
from .reach import KNOWN_BEYOND
from .settings import Bounds, SiteSettings


@dataclass(frozen=True)
class Site:
    """One published site; every geometry is in the site frame, in metres."""

    settings: SiteSettings
    outlines: Outlines
    centrelines: tuple[Centreline, ...]
    surfaces: tuple[Surface, ...]
    keepouts: tuple[Area, ...]

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

    def contains(self, x: float, y: float) -> bool:
        """Tell whether (x, y), metres in the site frame, lies in the site's bounds."""
        return self.bounds.contains(x, y)

    def whole_map(self) -> RobotMap:
        """Return the map that a robot gets after Ready: everything within the bounds (paper 1, III.A)."""
        return self._map(Window.from_bounds(*self.bounds))

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
        return self._index.map_of(window, meta=self.map_meta())

    @cached_property
    def surface_index(self) -> SurfaceIndex:
        """What tells the road surface at a place; made when it is asked for first."""
        return SurfaceIndex(self.surfaces)

    @cached_property
    def keepout_index(self) -> KeepoutIndex:
        """What tells which places and ways come into keepouts; made when it is asked for first."""
        return KeepoutIndex([area.rings for area in self.keepouts])

    @cached_property
    def _index(self) -> OutlineIndex:
        return OutlineIndex(self.outlines)

    def map_meta(self) -> dict[str, str]:
        """Return the leading lines of every map of this site (design, section 6)."""
        frame = self.frame
        return {
            "version": str(self.version),
            "crs": frame.crs,
            "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
            "rotation": f"{frame.rotation:.9f}",
            "id": self.id,
        }
