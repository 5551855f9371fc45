"""RoutingKit finds the gateway's ways in a process of its own, whose end costs no way and no closed road."""

from __future__ import annotations

import os
import signal
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from robot_bridge.core.roads.engines import ContractionEngines
from robot_bridge.core.roads.network import build_network, centrelines
from robot_bridge.core.roads.routes import Restrictions, Router
from robot_bridge.gateway.traffic import route_process
from robot_bridge.gateway.traffic.route_process import ProcessEngines
from tests.support.processes import freeze

pytest.importorskip("routingkit_cch", reason="the package has wheels for x86_64 alone")
ROUTINGKIT, SCIPY = ContractionEngines.name, "SciPy"
THERE = (-10.0, 0.0), (40.0, 20.0)
ROUND = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0), (0.0, 0.0)]
"""Two ways, of 50 m each, from corner to corner: edges 0 and 1, or 2 and 3; edges 4 and 5 lead there."""


@pytest.fixture
def change() -> str:
    """Return what the process does before it serves; tests put its defects here."""
    return ""


@pytest.fixture
def router(monkeypatch: pytest.MonkeyPatch, change: str) -> Iterator[Router]:
    """Return a router whose ways RoutingKit finds in a process, and that may not load it itself."""

    def never(*given: object) -> None:
        raise AssertionError("RoutingKit is made in the process of the gateway")

    monkeypatch.setattr(ContractionEngines, "__init__", never)
    monkeypatch.setattr(route_process, "LEAST_ARCS", 1)
    monkeypatch.setattr(route_process, "FIRST_WAIT_S", 0.01)
    if change:
        monkeypatch.setattr(route_process, "ANSWER_WITHIN_S", 2.0)
        start_with(monkeypatch, change)
    lines = [np.array(ROUND[k : k + 2]) for k in range(4)]
    lines += [np.array([THERE[0], ROUND[0]]), np.array([ROUND[2], THERE[1]])]
    roads = centrelines(lines, width=[9.0, 9.0, 4.0, 4.0, 9.0, 9.0])
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


def start_with(monkeypatch: pytest.MonkeyPatch, change: str) -> None:
    """Have the next process run ``change`` before it serves, with its modules and the pipe's ``handle``."""

    def program(handle: int) -> str:
        return f"""
import os, sys, time
sys.path = {sys.path!r}
from robot_bridge.core.roads.engines import ContractionEngine, ContractionEngines
from robot_bridge.gateway.traffic.route_process import serve
handle = {handle}
{textwrap.dedent(change)}
serve(handle)
"""

    monkeypatch.setattr(route_process, "_program", program)


def edges(router: Router, wanted: Restrictions | None = None) -> tuple[set[int], str]:
    """Return the edges of the way from corner to corner, and what found it."""
    route = router.route(*THERE, wanted)
    return set(route.edges.tolist()) - {4, 5}, route.engine


def test_ways_are_found_here_until_the_process_is_ready_and_there_from_then_on(router) -> None:
    router.close([0])
    assert edges(router)[0] == {2, 3}
    wait_for(lambda: is_ready(router))
    assert edges(router) == ({2, 3}, ROUTINGKIT)
    router.open([0])
    router.close([2])
    assert edges(router) == ({0, 1}, ROUTINGKIT)
    # Restrictions that are first asked for now, and a router for another thread with the same roads closed.
    wide = Restrictions(least_width=8.0)
    assert edges(router, wide)[0] == {0, 1}
    wait_for(lambda: edges(router, wide) == ({0, 1}, ROUTINGKIT))
    other = router.copy()
    router.open([2])
    router.close([0])
    assert edges(other)[0] == {0, 1}
    wait_for(lambda: edges(other) == ({0, 1}, ROUTINGKIT))
    assert edges(router) == ({2, 3}, ROUTINGKIT)


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


def test_for_costs_that_the_process_does_not_have_ways_are_found_here(router, monkeypatch) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    monkeypatch.setattr(ProcessEngines, "_lay_if_there", lambda *it: None)
    assert edges(router, Restrictions(least_width=8.0)) == ({0, 1}, SCIPY)
    assert edges(router)[1] == ROUTINGKIT


LAYS_FOR_EVER = "ContractionEngines.__call__ = lambda self, costs: time.sleep(1e6)"
LAYS_ONLY_ONE = """
    laid, lay = [], ContractionEngines.__call__
    ContractionEngines.__call__ = lambda *it: laid.append(1) or (time.sleep(1e6) if laid[1:] else lay(*it))
"""
AS_IT_IS = route_process._program


@pytest.mark.parametrize("change", [LAYS_ONLY_ONE])
def test_while_the_process_hangs_over_new_costs_no_way_waits_for_it(router) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    way, engine = edges(router)
    assert engine == ROUTINGKIT
    process, child = engines_of(router).process_id, engines_of(router)._child
    # Neither for the new costs nor for those that it has, and a road that is closed now is closed at once.
    assert edges(router, Restrictions(least_width=8.0)) == ({0, 1}, SCIPY)
    wait_for(lambda: child.lock.locked() or child.failed)
    assert edges(router)[1] == SCIPY
    router.close([min(way)])
    assert edges(router) == ({0, 1, 2, 3} - way, SCIPY)
    assert engines_of(router).process_id == process, "it was waited for until it was given up"


@pytest.mark.parametrize("change", [LAYS_FOR_EVER])
def test_a_process_that_lays_no_costs_is_killed_and_started_again(router, monkeypatch, caplog) -> None:
    monkeypatch.setattr(route_process, "LAID_WITHIN_S", 0.2)
    edges(router)
    wait_for(lambda: "because it said nothing for 0.2 s" in caplog.text)
    monkeypatch.setattr(route_process, "LAID_WITHIN_S", 60.0)
    monkeypatch.setattr(route_process, "_program", AS_IT_IS)
    wait_for(lambda: is_ready(router))
    assert edges(router)[1] == ROUTINGKIT


BEGINS = "ContractionEngine.way = lambda *it: os.write(handle, bytes({begin})) and {then}"
ANSWERS = "ContractionEngine.way = lambda *it: {}"
WRONG = {
    "is killed in mid-answer": (BEGINS.format(begin=[0, 0, 0, 8, 1], then="os._exit(1)"), "no whole answer"),
    "hangs in mid-answer": (BEGINS.format(begin=[0, 0, 0, 8, 1], then="time.sleep(1e6)"), "no whole answer"),
    "promises too much": (BEGINS.format(begin=[127] * 4, then="time.sleep(1e6)"), "no whole answer"),
    "says no word": (ANSWERS.format("time.sleep(1e6)"), "said nothing for 2 s"),
    "names arcs that there are not": (ANSWERS.format([1, 1000]), "are no way"),
    "answers half a number": ("import numpy; numpy.array = lambda *it: numpy.zeros(1, 'i4')", "are no way"),
    "raises": (ANSWERS.format("1 / 0"), "broke off"),
}


@pytest.mark.parametrize("change, fault", WRONG.values(), ids=WRONG)
def test_a_process_that_answers_wrongly_is_killed_and_ways_are_found_here(
    router, fault, caplog, monkeypatch
) -> None:
    monkeypatch.setattr(route_process, "FIRST_WAIT_S", 10_000.0)
    router.close([0])
    assert edges(router) == ({2, 3}, SCIPY)
    wait_for(lambda: is_ready(router))
    assert edges(router) == ({2, 3}, SCIPY)
    wait_for(lambda: "ended with status" in caplog.text)
    assert fault in caplog.text and not engines_of(router).report.ok


@pytest.mark.parametrize("change", ["pass"])
def test_a_process_that_reads_nothing_is_killed(router, monkeypatch, caplog) -> None:
    monkeypatch.setattr(route_process, "FIRST_WAIT_S", 10_000.0)
    edges(router)
    wait_for(lambda: is_ready(router))
    child = engines_of(router)._child
    freeze(child.process.pid)
    with pytest.raises(LookupError), child.lock:
        child.send(bytes(1 << 24))
    wait_for(lambda: "because it did not read a message" in caplog.text)


def test_an_answer_is_a_way_when_its_arcs_lead_from_end_to_end(router) -> None:
    graph = router._graph
    first, second = next(
        (a, b)
        for a in range(len(graph.tail))
        for b in range(len(graph.tail))
        if graph.head[a] == graph.tail[b] and graph.head[b] != graph.tail[a]
    )
    starts, goals = [(graph.tail[first], 0.0)], [(graph.head[second], 0.0)]

    def leads(*way: int, begins=starts, ends=goals) -> bool:
        return engines_of(router)._leads(np.array(way, np.int64).tobytes(), begins, ends)

    assert leads(first, second) and leads(ends=starts)
    assert not leads()
    assert not leads(first) and not leads(second)
    assert not leads(first, first, second)
    assert not leads(first, 1000, second)
    assert not leads(-1, begins=[(graph.tail[-1], 0.0)], ends=[(graph.head[-1], 0.0)])


def test_a_process_that_was_given_up_is_asked_no_more(router) -> None:
    edges(router)
    wait_for(lambda: is_ready(router))
    child = engines_of(router)._child
    child.failed = True
    assert edges(router)[1] == SCIPY and not engines_of(router).report.ok
    with pytest.raises(LookupError), child.lock:
        child.ask(("way", 0, [(0, 0.0)], [(0, 0.0)]), 5.0)
