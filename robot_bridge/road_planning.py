"""Paths along the roads of the published site."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable

import numpy as np

from .errors import RefusedError
from .planning import Planned, Point
from .roads.centrelines import Floats, centrelines
from .roads.dense import Driving, dense_path
from .roads.errors import NoRouteError, OffNetworkError
from .roads.keepouts import edges_through
from .roads.network import build_network
from .roads.route import Route, stretch
from .roads.routes import Router
from .sites.site import Site

log = logging.getLogger(__name__)


class RoadPlanner:
    """Finds the shortest way along the centrelines of the site that ``site`` returns, around its keepouts.

    The network is built here, and again when the site is another. Safe to use from several threads.
    """

    def __init__(self, site: Callable[[], Site], driving: Driving | None = None) -> None:
        self._site = site
        self._driving = driving or Driving()
        self._building = threading.Lock()
        self._built: tuple[Site, Router | None] = self._build(site())

    def path(self, start: Point, goal: Point) -> Planned:
        """Return the path, a straight line with a note where the site has no roads near both places.

        :raises RefusedError: when roads are near and no way leads along them.
        """
        router = self._router()
        if router is None:
            return Planned([start, goal])
        try:
            route = router.route(start, goal)
        except OffNetworkError as error:
            return Planned([start, goal], f"the path is a straight line and not along roads: {error}")
        except NoRouteError as error:
            raise RefusedError(f"GetPath: {error}") from error
        points, widths = _with_ends(route, start, goal)
        dense = dense_path(points, widths, self._driving).points
        return Planned([start, *((round(x, 3), round(y, 3)) for x, y in dense[1:-1].tolist()), goal])

    def _router(self) -> Router | None:
        with self._building:
            site = self._site()
            if self._built[0] is not site:
                self._built = self._build(site)
            return self._built[1]

    def _build(self, site: Site) -> tuple[Site, Router | None]:
        if not site.centrelines:
            return site, None
        network = build_network(
            centrelines(
                [line.points for line in site.centrelines],
                width=[line.width_m for line in site.centrelines],
                surface=[line.surface for line in site.centrelines],
                direction=[line.direction for line in site.centrelines],
                speed=[line.speed_ms for line in site.centrelines],
                closed=[line.closed for line in site.centrelines],
                level=[line.level for line in site.centrelines],
            )
        )
        router = Router(network)
        closed = edges_through(network, [area.rings for area in site.keepouts])
        router.close(closed.tolist())
        log.info(
            "paths follow the roads of site %s: %d edges, %d of them closed by keepouts, found by %s",
            site.id,
            len(network),
            len(closed),
            router.engine_name,
        )
        return site, router


def _with_ends(route: Route, start: Point, goal: Point) -> tuple[Floats, Floats]:
    """Return the points from ``start`` to ``goal`` and the width of road along each piece.

    Who stands beside the middle of a road joins it aslant, not square.
    """
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route.points, axis=0).T))])
    half = (route.widths[0] / 2, route.widths[-1] / 2)
    ahead, behind = (
        min(off, route.metres / 3) if off <= wide else 0.0
        for off, wide in zip((route.off_start, route.off_goal), half, strict=True)
    )
    middle = stretch(route.points, ahead, route.metres - behind)
    points = np.concatenate([[start], middle, [goal]])
    along = ahead + np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(middle, axis=0).T))])
    piece = np.searchsorted(stations, (along[1:] + along[:-1]) / 2, side="right") - 1
    inner = route.widths[np.clip(piece, 0, len(route.widths) - 1)]
    widths = np.concatenate([route.widths[:1], inner, route.widths[-1:]])
    moves = np.hypot(*np.diff(points, axis=0).T) > math.ulp(1e6)
    moves[-1:] |= not moves.any()
    return np.concatenate([points[:1], points[1:][moves]]), widths[moves]
