"""Closed roads and robots in each other's way: how long a closure and a look at all ways take."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

import numpy as np

from benchmarks.clock import FEW, Spread, again, once, spread
from benchmarks.trial import size
from robot_bridge.core.errors import NoRouteError, OffNetworkError
from robot_bridge.core.geometry import Polyline
from robot_bridge.core.messages.robots import SetPath
from robot_bridge.core.roads.network import Network
from robot_bridge.core.roads.path_smoothing import Driving, dense_path
from robot_bridge.core.roads.routes import Place, Router
from robot_bridge.core.sites.settings_tables import RouteSettings
from robot_bridge.gateway.traffic.conflicts import Conflict, Movement, conflicts_of, find_conflicts
from robot_bridge.gateway.traffic.robot_paths import DrivenTask, TrafficSnapshot
from robot_bridge.gateway.traffic.site_roads import ClosedRoads

CLOSURES, LIMIT = size(40, 5), 10.0
"""edges closed one after the other, and milliseconds within which that must be honoured."""
FLEETS = size((100, 1000), (20,))
ENGINES = ("contraction", "scipy")
SPEED, MARGIN = 1.0, 0.5
"""metres a second, and metres."""

RUNS = size(5, 2)

HEAD = """{closures} roads are closed one after the other, each in the middle of a way that had just been
found. Honoured: the milliseconds from asking for the closure until the next way, found without it, is there;
what is closed is laid over the costs when that way is asked for. Of SciPy's time nearly all is the way
itself. On the grid a street between its halves changes what a great part of the hierarchy costs.

| network | engine | honoured: median | honoured: most |
|---|---|---|---|
{honoured}

Goal on {limited}, with RoutingKit: at most {limit:g} ms; {late}.

On Malta, to hold a path of {metres:.1f} km and {points} points against {closures} closures takes {order:.1f}
ms, beside the gateway's event loop.

One look at all robots, as the gateway takes it about once a second beside its event loop: what is left of
each way, then the conflicts. Pair by pair: every two robots whose whole ways come near one another are held
against each other; the conflicts are the same.

| robots on ways of Malta at once | conflicts | ways left | conflicts found | pair by pair | times as long |
|---|---|---|---|---|---|
{conflicts}
"""


def traffic(networks: Mapping[str, Network], limited: Collection[str]) -> tuple[str, bool]:
    """Return what was measured on ``networks``, by their names, the first of which is Malta.

    The second is whether RoutingKit honours any closure too late on one of those ``limited``.
    """
    rows, late = [], False
    for name, network in networks.items():
        for engine in ENGINES:
            router = Router(network, engine)
            took = _honoured(router)
            late |= name in limited and engine == "contraction" and max(took) > LIMIT
            honoured = f"{spread(took):.1f} ms | {max(took):.1f} ms"
            rows.append(f"| {name} | {router.engine_name} | {honoured} |")
    network = next(iter(networks.values()))
    router = Router(network)
    order, longest = _order(router)
    text = HEAD.format(
        closures=CLOSURES,
        limited=" and ".join(limited),
        limit=LIMIT,
        late="**missed**" if late else "met",
        honoured="\n".join(rows),
        metres=np.hypot(*np.diff(longest, axis=0).T).sum() / 1000,
        points=len(longest),
        order=order,
        conflicts="\n".join(_conflicts(router, count) for count in FLEETS),
    )
    return text, late


def _honoured(router: Router) -> list[float]:
    """Return the milliseconds of closing and the next way, for each closure."""
    whole = []
    shut: list[int] = []
    for start, goal in _pairs(router, CLOSURES, near=2000.0):
        edges = router.route(start, goal).edges
        edge = int(edges[len(edges) // 2])
        took, left = _timed(
            lambda edge=edge, a=start, b=goal: (router.close([edge]), _edges(router, a, b))[1]
        )
        assert edge not in left
        shut.append(edge)
        whole.append(took)
    router.open(shut)
    return whole


def _without(router: Router, edge: int, start: Place, goal: Place) -> list[int]:
    router.close([edge])
    return _edges(router, start, goal)


def _order(router: Router) -> tuple[Spread, np.ndarray]:
    """Return the milliseconds of holding the longest of some paths against closures, and that path."""
    paths = [_dense(router, *pair) for pair in _pairs(router, 30)]
    longest = max(paths, key=len)
    edges = np.random.default_rng(8).choice(len(router.network), CLOSURES, replace=False).tolist()
    router.close(edges)
    closures = {str(edge): frozenset([edge]) for edge in edges}
    closed = ClosedRoads(router.nearest, closures, router.closed)
    took = spread(_timed(lambda: closed.along(longest.tolist()))[0] for _ in range(FEW))
    router.open(edges)
    return took, longest


def _conflicts(router: Router, count: int) -> str:
    underway, places = [], {}
    for number, pair in enumerate(_pairs(router, count, near=1000.0)):
        line = Polyline(_dense(router, *pair).tolist())
        path, robot = SetPath(line.beyond(-1.0).tolist()), f"r{number}"
        underway.append(DrivenTask(robot, f"c{number}", path, path.points[0], 0.0, None, line))
        places[robot] = path.points[0], SPEED
    seen = TrafficSnapshot(0.0, RouteSettings(margin_m=MARGIN), underway, places, {}, frozenset(places))
    moving, left = again(seen.movements, RUNS)
    movements = list(moving.values())
    found, took = again(lambda: find_conflicts(movements, MARGIN, 0.0), RUNS)
    same, slowly = again(lambda: _pair_by_pair(movements), RUNS)
    assert found == same
    milliseconds = [f"{seconds.scaled(1000):.0f} ms" for seconds in (left, took, slowly)]
    times = f"{' | '.join(milliseconds)} | {slowly.median / took.median:.1f}"
    return f"| {count} | {len(found)} | {times} |"


def _pair_by_pair(movements: list[Movement]) -> list[Conflict]:
    reach = np.array([movement.radius + MARGIN for movement in movements])[:, None]
    low = np.array([movement.points.min(axis=0) for movement in movements]) - reach
    high = np.array([movement.points.max(axis=0) for movement in movements]) + reach
    found: list[Conflict] = []
    for one in range(len(movements) - 1):
        near = (low[one + 1 :] <= high[one]).all(axis=1) & (high[one + 1 :] >= low[one]).all(axis=1)
        for other in (np.flatnonzero(near) + one + 1).tolist():
            found += conflicts_of(movements[one], movements[other], MARGIN, 0.0)
    return sorted(found, key=lambda conflict: (conflict.begins, conflict.robot, conflict.other))


def _pairs(
    router: Router, count: int, near: float = np.inf
) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return places at most ``near`` metres apart between which there is a way."""
    network: Network = router.network
    random = np.random.default_rng(5)
    found = []
    while len(found) < count:
        a = network.nodes[random.integers(len(network.nodes))]
        away = np.hypot(*(network.nodes - a).T)
        b = network.nodes[random.choice(np.flatnonzero((away > 100.0) & (away <= near)))]
        pair = tuple(a.tolist()), tuple(b.tolist())
        if _edges(router, *pair):
            found.append(pair)
    return found


def _edges(router: Router, start: tuple[float, float], goal: tuple[float, float]) -> list[int]:
    try:
        return router.route(start, goal).edges.tolist()
    except (NoRouteError, OffNetworkError):
        return []


def _dense(router: Router, start: tuple[float, float], goal: tuple[float, float]) -> np.ndarray:
    route = router.route(start, goal)
    return dense_path(route.points, route.widths, Driving()).points


def _timed(work: Callable[[], object]) -> tuple[float, object]:
    """Return the milliseconds of processor time that ``work`` took, and what it returned."""
    result, seconds = once(work)
    return 1000 * seconds, result
