"""One link for a thousand robots, beside a connection for each of them: two gateways, measured in turns."""

from __future__ import annotations

import statistics
from contextlib import ExitStack
from typing import NamedTuple

from benchmarks.clock import spread, table
from benchmarks.load import LATE_MS, MANY, RATE, SECONDS, SWARM_CORE, serving
from benchmarks.page import goal
from benchmarks.swarm import Plan, Seen, Swarm
from benchmarks.trial import size

GOAL = 0.5
TURNS, MOST_TURNS = size((5, 12), (2, 2))
"""pairs of windows that count, and that are measured at most for them."""
LOOKING, PROBING = 5.0, 50.0
"""Hz at which an operator asks for positions: as the panel does, and to tell how old they are."""
TOGETHER_MS = 50.0
HEAD = (
    "robots",
    "positions/s",
    "gateway's CPU, % of a core",
    "CPU of a position, µs",
    "delay, ms: median",
    "p99",
    "never read",
)
TEXT = """\
The same robots say where they are at {rate:g} Hz, once by a connection of each and once by one link, which
tells what is new of all of them every {together:g} ms, as the adapters' own client does. Everything runs:
validation, limits, liveness, trajectories into SQLite. Both gateways are there all the time, and are measured
in turns, {turns} windows of {seconds:g} s each count, of {measured}; the ratio is the median of those of two
windows one after the other. Two operators look on at {looking:g} Hz, in the form that the panel in QGIS asks
for. The delay is of windows of its own, from the robot's clock to an operator at {probing:g} Hz.

{rows}

Over one link the gateway took **{ratio}** of the processor time of a position; {verdict}. {late}
"""


class Kind(NamedTuple):
    """A way of connecting: windows that tell what it costs, and windows that tell how old positions are."""

    name: str
    cost: list[Seen]
    delay: list[Seen]

    def row(self) -> list[str]:
        """Return the row of the table."""
        median, p99 = (
            spread(one.delays[part] or 0.0 for one in self.delay if one.delays[part] is not None)
            for part in (0, 1)
        )
        return [
            f"{MANY} robots, {self.name}",
            f"{spread(one.rate for one in self.cost):.0f}",
            f"{spread(100 * one.cpu for one in self.cost):.1f}",
            f"{spread(1e6 * one.cpu / one.rate for one in self.cost):.1f}",
            f"{median:.0f}",
            f"{p99:.0f}",
            f"{sum(one.unread for one in [*self.cost, *self.delay])}",
        ]


def section() -> str:
    """Return what was measured, as Markdown."""
    each, one = kinds = Kind("a connection each", [], []), Kind("one link", [], [])
    for probe_rate in (LOOKING, PROBING):
        with ExitStack() as stack:
            swarms = [stack.enter_context(_swarm(stack, kind is one, probe_rate)) for kind in kinds]
            for _turn in range(MOST_TURNS if probe_rate == LOOKING else max(TURNS // 2, 1)):
                for kind, swarm in zip(kinds, swarms, strict=True):
                    seen = kind.cost if probe_rate == LOOKING else kind.delay
                    seen.append(swarm.window(RATE, SECONDS))
                if probe_rate == LOOKING and sum(_is_calm(one) for one in each.cost) >= TURNS:
                    break
    measured, late = len(each.cost), _late(each.cost)
    calm = [_is_calm(seen) for seen in each.cost]
    if sum(calm) > 1:
        for kind in kinds:
            kind.cost[:] = [seen for seen, counts in zip(kind.cost, calm, strict=True) if counts]
    ratios = [b.cpu / b.rate / (a.cpu / a.rate) for a, b in zip(each.cost, one.cost, strict=True)]
    return TEXT.format(
        rate=RATE,
        together=TOGETHER_MS,
        turns=len(each.cost),
        measured=measured,
        seconds=SECONDS,
        looking=LOOKING,
        probing=PROBING,
        rows=table(HEAD, [kind.row() for kind in kinds]),
        ratio=f"{spread(ratios):.2f}",
        verdict=goal(f"{GOAL:g} at most", statistics.median(ratios) <= GOAL),
        late=late,
    )


def _swarm(stack: ExitStack, over_link: bool, probe_rate: float) -> Swarm:
    pid, port = stack.enter_context(serving())
    plan = Plan(
        "127.0.0.1", port, pid, MANY, 1, operator_rate=LOOKING, probe_rate=probe_rate, over_link=over_link
    )
    return Swarm(plan, SWARM_CORE)


def _is_calm(seen: Seen) -> bool:
    """Tell whether robots were in time: else their messages come in heaps, which cost less each."""
    return seen.late <= LATE_MS


def _late(seen: list[Seen]) -> str:
    """Return how late robots with a connection each were in all windows, and what became of those."""
    late = [one.late for one in seen]
    busy = sum(not _is_calm(one) for one in seen)
    if not busy:
        return f"Robots with a connection each were {max(late):.0f} ms late at most."
    return (
        f"In {busy} of {len(late)} windows robots with a connection each were late by more than {LATE_MS:g} "
        f"ms, by {max(late):.0f} at most: the machine was too busy. Their messages then come in heaps, and "
        "cost the gateway less than they would. Such pairs of windows count only where there are fewer than "
        "two others."
    )
