"""The part on faults: what is left of commands, observations and positions when something dies."""

from __future__ import annotations

import random
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from benchmarks.clock import spread, table
from benchmarks.page import Part, goal
from benchmarks.trial import size
from tests.support.errors import StageError
from tests.support.faults import breaking
from tests.support.faults.audit import LAST_WORDS_S, LOST_WITH_ROBOT, LOST_YOUNG, YOUNG_S, Findings
from tests.support.faults.desk import LONGEST_BEFORE_ABORT, SHARE_ABORTED
from tests.support.faults.disk import Disk
from tests.support.faults.runs import (
    ROBOTS,
    SERVERS,
    broken_on_server,
    broken_on_small_disk,
    broken_on_sqlite,
)
from tests.support.faults.yard import DESKS, GATEWAY_KILLED, ROBOTS_KILLED, Yard

GATEWAY_KILLS, SERVER_KILLS, ROBOT_KILLS = size((50, 10, 10), (2, 1, 1))
CUTS, CUT_S = size((3, 10.0), (1, 3.0))
LONGEST_SEED = 10**6
NAMES = {"sqlite": "SQLite", "postgresql": "PostgreSQL", "mariadb": "MariaDB"}

TEXT = """\
A real gateway on a real database that waits for the disk at every commit; {robots} robots, half on WebSocket,
half on SQL with the rights of their accounts, which write down every message that they act on with its id;
{desks} desks that send them numbered commands, one after the other, {aborted:.0f} % of them at random
followed by an Abort within {abort:g} s, and ask again under the same id where they get no answer. Everything
dies by SIGKILL, at random moments (seed {seed}). What was killed is started again, and nobody does anything
else. A full disk or a broken network lasts {cut:g} s each time. Then the database is held against
what the desks were told and the robots wrote down.

{commands}

Told: commands that an operator was told are queued. Each of them was delivered, acted on once, and has ended,
in an order of steps that can be. Those told and not acted on were aborted before the robot read them; those
acted on again were told to a robot that was started again and had forgotten them. Asked again: for want of an
answer. Back after: seconds from the fault, its own length and the start of what was killed included, to the
next command that was reached.

{kept}

Accepted: the robot was told so; each is stored once, as it was told. Lost young: positions that a robot told
within {young:g} s before the gateway was killed; none that was older is lost. Lost with the robot: positions
that it told within {last_words:g} s before it was itself killed, and that went down with its connection.
Stored twice: positions of which the gateway did not know that they were stored, when it or its database died.

Wrong in all of this: {wrong} ({goal}).
"""


class Run(NamedTuple):
    """One kind of fault on one kind of database."""

    kind: str
    fault: str
    findings: Findings


def measure(_data: Path) -> Part:
    """Break everything on each kind of database."""
    seed = random.randrange(LONGEST_SEED)
    print(f"seed {seed}", file=sys.stderr)
    return part(seed, list(_runs(seed)))


def part(seed: int, runs: list[Run]) -> Part:
    """Return what is told of some runs, which were random by ``seed``."""
    wrong = [f"{run.kind}, {run.fault}: {text}" for run in runs for text in run.findings.wrong]
    text = TEXT.format(
        robots=ROBOTS,
        desks=DESKS,
        aborted=100 * SHARE_ABORTED,
        abort=LONGEST_BEFORE_ABORT,
        seed=seed,
        cut=CUT_S,
        commands=_commands(runs),
        kept=_kept(runs),
        young=YOUNG_S,
        last_words=LAST_WORDS_S,
        wrong=len(wrong) or "nothing",
        goal=goal("nothing", not wrong),
    )
    return Part("Faults", "\n".join([text, *(f"- {sentence}" for sentence in wrong)]), bool(wrong))


def _runs(seed: int) -> Iterator[Run]:
    for kind in NAMES:
        for fault, break_it in _faults(kind).items():
            with tempfile.TemporaryDirectory(prefix="fleet-faults-") as folder:
                findings = _broken(kind, Path(folder), seed, fault, break_it)
            print(f"--- {kind}, {fault}\n{findings.lines()}", file=sys.stderr, flush=True)
            yield Run(kind, fault, findings)


def _faults(kind: str) -> dict[str, Callable[..., None]]:
    faults: dict[str, Callable[..., None]] = {
        GATEWAY_KILLED: lambda yard: breaking.kill_gateway(yard, GATEWAY_KILLS),
        ROBOTS_KILLED: lambda yard: breaking.kill_robots(yard, ROBOT_KILLS),
    }
    if kind not in SERVERS:
        return {**faults, breaking.DISK_FULL: _fill_disk}
    return {
        **faults,
        breaking.SERVER_KILLED: lambda yard: breaking.kill_server(yard, SERVER_KILLS),
        breaking.STALLED: lambda yard: _cut(breaking.stall_network, yard),
        breaking.REFUSED: lambda yard: _cut(breaking.reset_network, yard),
    }


def _fill_disk(yard: Yard, disk: Disk) -> None:
    for _ in range(CUTS):
        breaking.fill_disk(yard, disk, CUT_S)


def _cut(cut: Callable[[Yard, float], None], yard: Yard) -> None:
    for _ in range(CUTS):
        cut(yard, CUT_S)


def _broken(kind: str, folder: Path, seed: int, fault: str, break_it: Callable[..., None]) -> Findings:
    try:
        if kind in SERVERS:
            return broken_on_server(kind, folder, seed, break_it)
        if fault == breaking.DISK_FULL:
            return broken_on_small_disk(folder, seed, break_it)
        return broken_on_sqlite(folder, seed, break_it)
    except StageError as error:
        return Findings(wrong=[str(error)])


def _commands(runs: list[Run]) -> str:
    head = ["database", "fault", "times", "told", "acted on", "again", "reached", "aborted", "asked again"]
    counted = [
        "commands told queued",
        "acted on",
        "acted on again by a robot that had forgotten it",
        "... reached",
        "... aborted",
        "asked again for want of an answer",
        "refused with an error",
    ]
    rows = [[*_row(run, counted), *_back(run.findings.back_after)] for run in runs]
    return table([*head, "refused", "back after, s", "at most"], rows)


def _back(seconds: list[float]) -> list[str]:
    return [f"{spread(seconds):.1f}", f"{max(seconds):.1f}"] if seconds else ["–", "–"]


def _kept(runs: list[Run]) -> str:
    head = ["database", "fault", "times", "objects accepted", "images accepted", "positions told", "stored"]
    counted = [
        "objects accepted",
        "images accepted",
        "positions told",
        "... stored",
        LOST_YOUNG,
        LOST_WITH_ROBOT,
        "... stored twice",
    ]
    head += ["lost young", "lost with the robot", "stored twice"]
    return table(head, [_row(run, counted) for run in runs])


def _row(run: Run, counted: list[str]) -> list[str]:
    counts = run.findings.counts
    return [NAMES[run.kind], run.fault, str(counts[run.fault]), *(str(counts[name]) for name in counted)]
