"""The part on roads: the network, its faults, and routes, on Malta, a made-up grid and a real track."""

from __future__ import annotations

import importlib
import resource
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import networkx
import numpy as np
import shapely

from benchmarks.clock import FEW, Spread, again, once, spread
from benchmarks.page import Part, goal
from benchmarks.road_data import four_islands, grid, malta, track, track_surface
from benchmarks.road_rivals import (
    by_graph_analyzer,
    by_native,
    by_networkx,
    by_routingkit,
    directed,
    start_qgis,
)
from benchmarks.road_traffic import traffic
from benchmarks.trial import size
from robot_bridge.core.errors import NoRouteError
from robot_bridge.core.roads.network import Network, build_network
from robot_bridge.core.roads.network_checks import count_by_kind, find_road_defects, repaired_network
from robot_bridge.core.roads.path_smoothing import Driving, dense_path
from robot_bridge.core.roads.routes import Router
from tools.plugin_files import PACKAGE, register_plugin

TOLERANCE = 0.5
SIDE = size(317, 40)
"""Streets along each side of the made-up grid."""
PAIRS, STARTS = size((1000, 50), (50, 5))
SLOW = size(30, 4)
"""How many ways are asked of what takes a tenth of a second for each."""
MOST = size(None, 1500)
"""How many of Malta's roads are taken: all."""
RUNS, CLOSED = size(5, 2), 100
"""How often each is asked the same, and edges that are closed at once."""
PRECISE, NEAR = 1e-6, 0.1
"""Metres that lengths may differ by, and that a path may be off a surface."""
ENGINES = {"contraction": PAIRS, "scipy": SLOW, "plain": SLOW}

TEXT = """\
Ways per second count a whole question: both places taken to the nearest edge, the way, and its stretches;
those of the others begin at nodes. All times are processor time.

### The network

| | roads | edges | nodes | built in | memory |
|---|---|---|---|---|---|
{built}

### What is broken, with {tolerance} m

| | {kinds} |
|---|{rule}|
{findings}

### Ways per second

Each was asked the same ways {runs} times, one after the other on the same network.

| | Malta, {malta} edges | Malta four times, {four} edges | made-up grid, {town} edges |
|---|---|---|---|
{speeds}

A grid is hard for contraction hierarchies: no few crossings part it. A query of RoutingKit that is kept is
for one thread only, and no road can be closed while there is one: the gateway makes one for each way.

Getting ready for ways costs {ready}. Closing {closed} edges, then a way: {closing}.

### Correctness

Malta: of {pairs} pairs with a way the greatest difference to networkx is {worst:.2e} m ({precise});
{disagreed} pairs have a way by one and none by the other ({agreed}).

{track}

### Closed roads and robots in each other's way

{traffic}
"""


def measure(data: Path) -> Part:
    """Measure on Malta, once and four times, on a grid of streets, and on ZalaZONE's track."""
    built, networks, findings = _networks(data)
    island, town = networks["Malta"], grid(SIDE)
    four = build_network(four_islands(malta(data, MOST)))
    large = {"Malta": island, "Malta four times": four, "the grid": town}
    speeds, ready, closing = _speeds(large)
    worst, disagreed, pairs = _held_against_networkx(island)
    told, late = traffic(large, limited=("Malta", "Malta four times"))
    text = TEXT.format(
        runs=RUNS,
        closed=CLOSED,
        precise=goal(f"at most {PRECISE:g} m", worst <= PRECISE),
        agreed=goal("none", disagreed == 0),
        built="\n".join(built),
        tolerance=TOLERANCE,
        kinds=" | ".join(count_by_kind([])),
        rule="|".join("---" for _ in count_by_kind([])),
        findings="\n".join(findings),
        malta=len(island),
        four=len(four),
        town=len(town),
        speeds="\n".join(speeds),
        ready=ready,
        closing=closing,
        pairs=pairs,
        worst=worst,
        disagreed=disagreed,
        track=_on_the_track(networks["ZalaZONE, repaired"], data),
        traffic=told,
    )
    return Part("Roads", text, failed=late or worst > PRECISE or disagreed > 0)


def _networks(data: Path) -> tuple[list[str], dict[str, Network], list[str]]:
    built, networks, findings = [], {}, []
    for name, roads in (("Malta", malta(data, MOST)), ("ZalaZONE", track(data))):
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        network, first = once(lambda roads=roads: build_network(roads))
        grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
        more = [once(lambda roads=roads: build_network(roads))[1] for _ in range(RUNS - 1)]
        seconds = spread([first, *more])
        mended, done = repaired_network(roads, TOLERANCE)
        sizes = f"{len(roads)} | {len(network)} | {len(network.nodes)}"
        # After a great network a small one needs no more than was there.
        memory = f"{grown:.0f} MB" if grown > 1 else "–"
        built.append(f"| {name} | {sizes} | {seconds:.2f} s | {memory} |")
        networks |= {name: network, f"{name}, repaired": mended}
        found = find_road_defects(network, TOLERANCE)
        left = find_road_defects(mended, TOLERANCE)
        for what, counted in (("found", found), ("repaired", done), ("left", left)):
            findings.append(f"| {name}: {what} | {' | '.join(map(str, count_by_kind(counted).values()))} |")
    return built, networks, findings


def _speeds(networks: dict[str, Network]) -> tuple[list[str], str, str]:
    application = start_qgis()
    rows: dict[str, list[str]] = {}
    ready, closing = [], []
    for name, network in networks.items():
        for engine, count in ENGINES.items():
            router = Router(network, engine)
            rows.setdefault(router.engine_name, []).append(_rate(_whole_route(router), network, count))
            if engine == "contraction":
                ready.append(f"{_ready(network):.1f} s on {name}")
                closing.append(f"{_closing(router):.1f} ms on {name}")
        for rival, (query, count) in _rivals(network).items():
            rows.setdefault(rival, []).append(_rate(query, network, count))
    assert application is not None
    return (
        [f"| {name} | {' | '.join(rates)} |" for name, rates in rows.items()],
        ", ".join(ready),
        ", ".join(closing),
    )


def _rivals(network: Network) -> dict[str, tuple[Callable[[int, int], object], int]]:
    """Return, of each rival, what asks it for a way and how many ways are asked for."""
    kept, made_for_each = by_routingkit(network)
    return {
        "RoutingKit alone, a query for each way": (made_for_each, PAIRS),
        "RoutingKit alone, one query kept": (kept, PAIRS),
        "networkx, A*": (by_networkx(network, directed(network)), 10),
        "QgsGraphAnalyzer, graph kept": (by_graph_analyzer(network, _graph_engine()), 10),
        "native:shortestpathpointtopoint": (by_native(network), 1),
    }


def _graph_engine() -> type:
    """Return the plugin's engine, by the name that QGIS knows the plugin's package by."""
    register_plugin()
    engine: type = importlib.import_module(f"{PACKAGE}.plugin.processing.common.road_sources").GraphEngine
    return engine


def _whole_route(router: Router) -> Callable[[int, int], object]:
    nodes = [tuple(node) for node in router.network.nodes.tolist()]

    def query(a: int, b: int) -> object:
        try:
            return router.route(nodes[a], nodes[b])
        except NoRouteError:
            return None

    return query


def _rate(query: Callable[[int, int], object], network: Network, count: int) -> str:
    pairs = _joined_pairs(network, count)
    query(*pairs[0])
    _, seconds = again(lambda: [query(a, b) for a, b in pairs], RUNS)
    slowest, fastest = len(pairs) / seconds.high, len(pairs) / seconds.low
    return f"{Spread(len(pairs) / seconds.median, slowest, fastest):.3g}"


def _joined_pairs(network: Network, count: int) -> list[tuple[int, int]]:
    """Return pairs of nodes of the greatest part, so that most of them have a way."""
    parts, sizes = np.unique(network.parts, return_counts=True)
    inside = np.flatnonzero(network.parts == parts[np.argmax(sizes)])
    picked = np.random.default_rng(4).choice(inside, (count, 2))
    return [(int(a), int(b)) for a, b in picked if a != b]


def _ready(network: Network) -> Spread:
    """Return the seconds until the first way is found, for which costs are laid over the network."""
    node = tuple(network.nodes[0].tolist())
    return again(lambda: Router(network, "contraction").route(node, node), RUNS)[1]


def _closing(router: Router) -> Spread:
    """Return the milliseconds of closing CLOSED edges and finding a way."""
    (a, b), *_ = _joined_pairs(router.network, 5)
    query = _whole_route(router)
    random = np.random.default_rng(2)
    seconds = []
    for _ in range(2 * FEW):
        edges = random.choice(len(router.network), CLOSED, replace=False).tolist()
        seconds.append(_timed(lambda edges=edges: (router.close(edges), query(a, b)))[0])
        router.open(edges)
    return spread(1000 * one for one in seconds)


def _held_against_networkx(network: Network) -> tuple[float, int, int]:
    """Return the greatest difference in metres, pairs that only one finds a way for, and pairs compared."""
    graph = directed(network)
    query = _whole_route(Router(network))
    worst, disagreed, compared = 0.0, 0, 0
    random = np.random.default_rng(1)
    for start in random.integers(0, len(network.nodes), STARTS).tolist():
        lengths = networkx.single_source_dijkstra_path_length(graph, start) if start in graph else {}
        for end in random.integers(0, len(network.nodes), PAIRS // STARTS).tolist():
            route = query(start, end)
            if (route is None) != (end not in lengths):
                disagreed += 1
            elif route is not None:
                worst = max(worst, abs(route.metres - lengths[end]))
                compared += 1
    return worst, disagreed, compared


def _on_the_track(network: Network, data: Path) -> str:
    """Return how far routes between random places of the track stay on its digitised surface."""
    surface = track_surface(data)
    router = Router(network)
    random = np.random.default_rng(6)
    shapely.prepare(surface)
    paths: list[np.ndarray] = []
    refused = 0
    while len(paths) + refused < PAIRS:
        pair = random.uniform(surface.bounds[:2], surface.bounds[2:], (2, 2))
        if not shapely.contains_xy(surface, pair).all():
            continue
        try:
            route = router.route(*map(tuple, pair.tolist()))
        except NoRouteError:
            refused += 1
            continue
        paths.append(dense_path(route.points, route.widths, Driving()).points)
    return _told(paths, refused, surface, network)


def _told(paths: Sequence[np.ndarray], refused: int, surface: shapely.Geometry, network: Network) -> str:
    lines = [shapely.LineString(points) for points in paths]
    outside = shapely.length(shapely.difference(lines, surface))
    metres = float(shapely.length(lines).sum())
    drawn = [shapely.LineString(network.edges.line(k)) for k in range(len(network))]
    off = shapely.length(shapely.difference(drawn, surface)).sum() / shapely.length(drawn).sum()
    longest = max(max(np.hypot(*(b - a)) for a, b in pairwise(points)) for points in paths)
    kept = int((outside < NEAR).sum())
    return (
        f"ZalaZONE's track, repaired: of {PAIRS} pairs of random places on its surface {len(paths)} have a "
        f"way by the lanes' directions, {refused} have none; {kept} of the paths stay on that surface "
        f"within {NEAR:g} m, {100 * (1 - outside.sum() / metres):.2f} % of all {metres / 1000:.0f} km do; of "
        f"the centrelines themselves {100 * (1 - off):.2f} % do. Points are at most {longest:.3f} m apart."
    )


def _timed(work: Callable[[], object]) -> tuple[float, object]:
    result, seconds = once(work)
    return seconds, result
