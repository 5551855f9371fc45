"""RoutingKit finds the gateway's ways in a process of its own, whose end costs no way and no closed road."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from robot_bridge.core.roads.centrelines import centrelines
from robot_bridge.core.roads.engines import ContractionEngines
from robot_bridge.core.roads.network import build_network
from robot_bridge.core.roads.routes import Restrictions, Router
from robot_bridge.gateway.traffic import route_process
from robot_bridge.gateway.traffic.route_process import ProcessEngines

pytest.importorskip("routingkit_cch", reason="the package has wheels for x86_64 alone")
ROUTINGKIT, SCIPY = ContractionEngines.name, "SciPy"
THERE = (0.0, 0.0), (30.0, 20.0)
ROUND = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0), (0.0, 0.0)]
"""Two ways, of 50 m each, from corner to corner: edges 0 and 1, or 2 and 3."""


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch) -> Iterator[Router]:
    """Return a router whose ways RoutingKit finds in a process, and that may not load it itself."""

    def never(*given: object) -> None:
        raise AssertionError("RoutingKit is made in the process of the gateway")

    monkeypatch.setattr(ContractionEngines, "__init__", never)
    monkeypatch.setattr(route_process, "LEAST_ARCS", 1)
    monkeypatch.setattr(route_process, "FIRST_WAIT_S", 0.01)
    roads = centrelines([np.array(ROUND[k : k + 2]) for k in range(4)], width=[9.0, 9.0, 4.0, 4.0])
    made = Router(build_network(roads), ProcessEngines)
    yield made
    engines_of(made).close()


def engines_of(router: Router) -> ProcessEngines:
    assert isinstance(router.engines, ProcessEngines)
    return router.engines


def wait_for(true: Callable[[], bool]) -> None:
    end = time.monotonic() + 240
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)


def is_ready(router: Router) -> bool:
    return engines_of(router).report.engine == ROUTINGKIT


def edges(router: Router, wanted: Restrictions | None = None) -> tuple[set[int], str]:
    """Return the edges of the way from corner to corner, and what found it."""
    route = router.route(*THERE, wanted)
    return set(route.edges.tolist()), route.engine


def test_ways_are_found_here_until_the_process_is_ready_and_there_from_then_on(router) -> None:
    router.close([0])
    assert edges(router)[0] == {2, 3}
    wait_for(lambda: is_ready(router))
    assert edges(router) == ({2, 3}, ROUTINGKIT)
    router.open([0])
    router.close([2])
    assert edges(router) == ({0, 1}, ROUTINGKIT)
    # Restrictions that are first asked for now, and a router for another thread with the same roads closed.
    assert edges(router, Restrictions(least_width=8.0)) == ({0, 1}, ROUTINGKIT)
    other = router.copy()
    router.open([2])
    router.close([0])
    assert (edges(other), edges(router)) == (({0, 1}, ROUTINGKIT), ({2, 3}, ROUTINGKIT))


@pytest.mark.parametrize("how", [signal.SIGABRT, signal.SIGSTOP], ids=["aborts", "hangs"])
def test_when_the_process_ends_ways_are_found_here_and_the_log_says_so(
    router, how, caplog, monkeypatch
) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    process = engines_of(router).process_id
    monkeypatch.setattr(route_process, "ANSWER_WITHIN_S", 0.2)
    monkeypatch.setattr(route_process, "FIRST_WAIT_S", 10_000.0)
    os.kill(process, how)
    router.close([0])
    assert edges(router) == ({2, 3}, SCIPY)
    wait_for(lambda: f"({process}) ended with status" in caplog.text)
    assert not engines_of(router).report.ok
    assert "SciPy finds ways until it has been started again" in caplog.text


def test_a_process_that_was_started_again_knows_what_was_closed_meanwhile(router) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    os.kill(engines_of(router).process_id, signal.SIGABRT)
    router.close([2])
    wait_for(lambda: engines_of(router).report.starts == 2 and is_ready(router))
    assert edges(router) == ({0, 1}, ROUTINGKIT)


def test_it_ends_with_its_gateway_and_ways_are_found_on(router) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    process = engines_of(router).process_id
    engines_of(router).close()
    wait_for(lambda: not Path(f"/proc/{process}").exists())
    assert edges(router)[1] == SCIPY
