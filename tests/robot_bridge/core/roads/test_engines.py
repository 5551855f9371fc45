"""Engines honour every change of costs, whichever thread asks, and leave nothing behind."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.roads.engines import ENGINES, Engine, RouteGraph, engines_for

NAMES = [name for name in ENGINES if name != "automatic"]

IN_TWO_THREADS = """
import threading
import numpy as np
from robot_bridge.core.roads.network import centrelines
from robot_bridge.core.roads.network import build_network
from robot_bridge.core.roads.routes import Router

square = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [0.0, 0.0]])
roads = centrelines([square[k : k + 2] for k in range(4)], width=4.0)
made = []
def make():
    made.append(Router(build_network(roads)))
    made[0].route((0, 0), (100, 0))
thread = threading.Thread(target=make)
thread.start()
thread.join()
router = made[0]
router.close([0])
print(router.engine_name, router.route((0, 0), (100, 0)).metres)
"""

WITHOUT_ROADS = """
from robot_bridge.core.roads.network import centrelines
from robot_bridge.core.errors import OffNetworkError
from robot_bridge.core.roads.network import build_network
from robot_bridge.core.roads.routes import Router

for engine in ("automatic", "contraction"):
    try:
        Router(build_network(centrelines([])), engine).route((0, 0), (1, 0))
    except OffNetworkError as error:
        print(engine, type(error).__name__)
"""


@pytest.fixture(params=NAMES)
def engine(request: pytest.FixtureRequest) -> str:
    needed = {"contraction": "routingkit_cch", "scipy": "scipy", "plain": "heapq"}
    pytest.importorskip(needed[request.param])
    return request.param


def cost(graph: RouteGraph, way: list[int] | None, costs: np.ndarray) -> float:
    return np.inf if way is None else float(costs[way].sum())


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6))
def test_after_any_changes_ways_cost_what_they_cost_from_the_beginning(seed: int) -> None:
    pytest.importorskip("routingkit_cch")
    random = np.random.default_rng(seed)
    # Few nodes, so that many arcs are parallel and some lead to where they begin.
    tail, head = random.integers(0, 6, (2, 20))
    graph = RouteGraph(random.uniform(0, 100, (6, 2)), tail, head)
    costs = random.integers(1, 50, 20).astype(np.float64)
    engines = [engines_for(graph, name)(costs) for name in NAMES]
    for _ in range(4):
        arcs = random.choice(20, 6, replace=False)
        costs[arcs] = np.where(random.uniform(size=6) < 0.6, np.inf, random.integers(1, 50, 6))
        anew = engines_for(graph, "plain")(costs)
        starts, goals = ([(int(node), 1.0)] for node in random.choice(6, 2, replace=False))
        wanted = cost(graph, anew.way(starts, goals), costs)
        for engine in engines:
            engine.set_costs(arcs, costs[arcs])
            assert cost(graph, engine.way(starts, goals), costs) == pytest.approx(wanted), engine.name


def test_a_layer_without_roads_has_no_way_and_ends_no_process(root) -> None:
    pytest.importorskip("routingkit_cch")
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_ROADS], capture_output=True, text=True, cwd=root, check=False,
        timeout=240,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, "automatic OffNetworkError\ncontraction OffNetworkError\n")


def test_of_parallel_arcs_the_cheapest_open_one_is_used(engine: str) -> None:
    graph = RouteGraph(np.array([(0.0, 0.0), (9.0, 0.0)]), np.zeros(3, np.int64), np.ones(3, np.int64))
    made = engines_for(graph, engine)(np.array([5.0, 3.0, 4.0]))
    used = [made.way([(0, 0.0)], [(1, 0.0)])]
    for arc, value in ((1, np.inf), (2, 9.0), (0, np.inf), (2, np.inf), (1, 3.0)):
        made.set_costs(np.array([arc]), np.array([value]))
        used.append(made.way([(0, 0.0)], [(1, 0.0)]))
    assert used == [[1], [2], [0], [2], None, [1]]


@pytest.fixture
def threads_taking_turns() -> Iterator[None]:
    """Let threads take turns as often as they can, so that what is not guarded goes wrong soon."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


@pytest.mark.usefixtures("threads_taking_turns")
def test_threads_that_ask_at_once_are_all_told_right(engine: str) -> None:
    # Over three arcs it is 30, and while arc 1 is closed 50 over another.
    nodes = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])
    graph = RouteGraph(nodes, np.array([0, 1, 2, 0]), np.array([1, 2, 3, 3]))
    made: Engine = engines_for(graph, engine)(np.array([10.0, 10.0, 10.0, 50.0]))
    told: list[object] = []

    def ask() -> None:
        for _ in range(300):
            try:
                told.append(made.way([(0, 0.0)], [(3, 0.0)]))
            except BaseException as error:  # RoutingKit panics
                told.append(error)

    asking = [threading.Thread(target=ask) for _ in range(3)]
    for thread in asking:
        thread.start()
    while any(thread.is_alive() for thread in asking):
        for value in (np.inf, 10.0):
            made.set_costs(np.array([1]), np.array([value]))
    assert [way for way in told if way not in ([0, 1, 2], [3])] == []
    assert made.way([(0, 0.0)], [(3, 0.0)]) == [0, 1, 2]


def test_a_router_made_in_one_thread_is_asked_in_another_and_ends_without_a_word(root) -> None:
    pytest.importorskip("routingkit_cch", reason="the package has wheels for x86_64 alone")
    done = subprocess.run(
        [sys.executable, "-c", IN_TWO_THREADS], capture_output=True, text=True, cwd=root, check=False,
        timeout=240,
    )  # fmt: skip
    assert done.stdout.startswith("contraction hierarchies")
    assert float(done.stdout.split()[-1]) == pytest.approx(300.0)
    assert done.stderr == ""
    assert done.returncode == 0
