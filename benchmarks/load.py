"""The part on load: how many positions one gateway takes, and how old they are when operators see them."""

from __future__ import annotations

import itertools
import shutil
import statistics
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from benchmarks.clock import Spread, spread, table
from benchmarks.page import Part, goal
from benchmarks.swarm import READ_WITHIN, Plan, Seen, Swarm
from benchmarks.trial import size
from robot_bridge.core.sites.settings_tables import LimitSettings
from tests.support.fleet import SITE, serve
from tests.support.processes import Processes

HERE = Path(__file__).parent
SERVER_CORE, SWARM_CORE = 0, 1
FEW_ROBOTS, MANY = size((100, 1000), (20, 100))
RATE, OPERATORS, STUCK = 10.0, 20, 10
WINDOWS = size(5, 2)
"""How often each is measured, for so many seconds:"""
SECONDS = size(5.0, 1.0)
STEP_SECONDS = size(4.0, 1.0)
LATE_MS = 50.0
"""by which robots may be late while the figures count."""
STEPS = size((10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0), (10.0, 20.0))
"""positions a second of each of the robots; the gateway itself allows no more than MOST_A_SECOND."""
GOAL_RATE, GOAL_MS = 25_000, 50
"""positions a second that a gateway is to take with a p99 below so many milliseconds."""
MOST_A_SECOND = LimitSettings().robot_messages_per_s
LIMITS = """
[limits]
per_address = 5000
desks_per_account = 100
"""
MALLOC = {"MALLOC_MMAP_THRESHOLD_": "4194304", "MALLOC_TRIM_THRESHOLD_": "67108864"}
"""As the systemd unit sets it."""

TEXT = """\
Robots on WebSocket send positions; operators subscribe to all robots at {operator_rate:g} Hz, in the form
that the panel in QGIS asks for; everything runs: validation, limits, liveness, trajectories into SQLite,
metrics. The gateway has a process and, as `taskset` holds it, one core of its own. The robots are one
process that only sends, the operators one that only looks; these two share the other core. The delay is
from the robot's clock to one more operator, who subscribes at {probe_rate:g} Hz, and is of positions that
are new to it: at {operator_rate:g} Hz the newest position of a robot is up to {between:g} s old by nature.
The wire's delay is from the gateway's clock to an operator at {operator_rate:g} Hz. Measuring begins when
every robot has its map and the gateway nothing left to do: {robots} robots that connected one after the
other had their maps after {arrival:.1f} s. Each row is of {windows} windows of {seconds:g} s. Where robots
were late by more than {late:g} ms, the machine was too busy for the figures beside it: {busy}.

{load}

The last two rows are a WebSocket server of a few lines on the same library and loop
(`benchmarks/plain_fanout.py`), which decodes and checks each position with the gateway's own
function: what that costs on this machine without all else that a gateway does, and what it comes to without
conflation. The gateway decodes positions out of the library's bytes before they are queued for a reader;
the small server queues them, as the library is meant to be used. So the gateway took {ratio:.2f} times the
processor time of the small server that drops them, for the same {rate} positions a second.

### Saturation

{robots} robots, {operators} operators and the one who measures; the rate is raised step by step, {windows}
windows of {step:g} s each. A step counts as kept up when in each of them every socket took every message
and the gateway had read all of them, by its own count, within {read_within:g} s after the last was sent.

{steps}

{verdict}

### Operators who do not read

{stuck_ones} more operators subscribe at {operator_rate:g} Hz and never read.

{stuck}
"""


@dataclass(frozen=True)
class Measured:
    """What some windows came to, and the seconds that the robots took to arrive before them."""

    name: str
    seen: list[Seen]
    arrival: float

    @property
    def kept_up(self) -> bool:
        """Whether every window was kept up."""
        return all(seen.kept_up for seen in self.seen)

    @property
    def swarm_kept_up(self) -> bool:
        """Whether the robots sent as fast as they were to in every window."""
        return all(seen.swarm_kept_up for seen in self.seen)

    @property
    def late(self) -> float:
        """The most milliseconds that a robot was late."""
        return max(seen.late for seen in self.seen)

    @property
    def rate(self) -> float:
        """Positions a second."""
        return statistics.median(seen.rate for seen in self.seen)

    @property
    def p99(self) -> Spread:
        """Milliseconds within which 99 % of the positions came to the one who measures."""
        return spread(seen.delays[1] or 0.0 for seen in self.seen)

    @property
    def cpu(self) -> Spread:
        """Percents of a core."""
        return spread(100 * seen.cpu for seen in self.seen)

    def row(self) -> list[str]:
        """Return the row of the table."""
        return [
            self.name,
            f"{self.rate:,.0f}",
            f"{self.cpu:.0f} %",
            *_both([seen.delays for seen in self.seen]),
            *_both([seen.ages for seen in self.seen]),
            f"{self.late:.0f}",
            f"{self.seen[0].megabytes_before:.0f} → {self.seen[-1].megabytes:.0f}",
        ]

    def step(self) -> list[str]:
        """Return the row of the table on saturation."""
        unread, held_back = (
            sum(getattr(seen, name) for seen in self.seen) for name in ("unread", "held_back")
        )
        return [
            *self.row()[1:5],
            f"{max(seen.read_after for seen in self.seen):.2f}",
            "yes" if self.kept_up else f"no: {unread} unread, {held_back} not taken",
            f"{self.late:.0f}",
            f"{spread(100 * seen.own_cpu for seen in self.seen):.0f} %",
        ]


DELAYS = ["delay, ms: median", "p99"]
HEAD = [
    "",
    "positions/s",
    "of a core",
    *DELAYS,
    "wire, ms: median",
    "p99",
    "robots late, ms, at most",
    "memory, MB",
]
STEP_HEAD = [*HEAD[1:5], "all read after, s, at most", "kept up", HEAD[7], "robots' process, of a core"]


def measure(_data: Path) -> Part:
    """Measure on the sample site."""
    rate, crowd = f"{RATE:g} Hz", f"{OPERATORS} operators"
    load = [_run(f"{robots} robots × {rate}, {crowd}", robots) for robots in (FEW_ROBOTS, MANY)]
    dropped = _run("the wire alone: positions decoded and dropped", MANY, peer="--drop", operators=0)
    forwarded = _run("every position decoded and forwarded to every operator", MANY, peer="--forward")
    stuck = _run(f"{MANY} robots × {rate}, {crowd}, {STUCK} stuck", MANY, stuck=STUCK)
    steps = list(_saturate())
    rows = [*load, dropped, forwarded]
    busy = [run.name for run in [*rows, stuck] if run.late > LATE_MS]
    text = TEXT.format(
        operator_rate=Plan.operator_rate,
        probe_rate=Plan.probe_rate,
        between=1 / Plan.operator_rate,
        windows=WINDOWS,
        seconds=SECONDS,
        step=STEP_SECONDS,
        late=LATE_MS,
        busy="; ".join(busy) or "nowhere",
        read_within=READ_WITHIN,
        robots=MANY,
        operators=OPERATORS,
        stuck_ones=STUCK,
        rate=f"{load[-1].rate:,.0f}",
        arrival=spread(run.arrival for run in (load[-1], stuck, steps[0])),
        ratio=load[-1].cpu.median / dropped.cpu.median,
        load=table(HEAD, [run.row() for run in rows]),
        steps=table(STEP_HEAD, [step.step() for step in steps]),
        verdict=_verdict(steps),
        stuck=table(HEAD, [load[-1].row(), stuck.row()]),
    )
    return Part("Load", text, settings=MALLOC)


def _run(name: str, robots: int, *, stuck: int = 0, peer: str = "", operators: int = OPERATORS) -> Measured:
    with serving(peer) as (pid, port):
        plan = Plan("127.0.0.1", port, pid, robots, operators, stuck=stuck, rpc=not peer)
        with Swarm(plan, SWARM_CORE) as swarm:
            seen = [swarm.window(RATE, SECONDS) for _ in range(WINDOWS)]
            return _told(Measured(name, seen, swarm.arrival))


def _saturate() -> Iterator[Measured]:
    """Yield steps up to the first at which the gateway falls behind, or the robots do."""
    with serving() as (pid, port), Swarm(Plan("127.0.0.1", port, pid, MANY, OPERATORS), SWARM_CORE) as swarm:
        for rate in STEPS:
            seen = [swarm.window(rate, STEP_SECONDS) for _ in range(WINDOWS)]
            step = _told(Measured(f"{MANY} robots × {rate:.0f} Hz", seen, swarm.arrival))
            yield step
            if not (step.kept_up and step.swarm_kept_up):
                return


def _verdict(steps: Sequence[Measured]) -> str:
    """Return what is claimed: the highest rate that was kept up before the first that was not."""
    kept = list(itertools.takewhile(lambda step: step.kept_up, steps))
    fast = list(itertools.takewhile(lambda step: step.p99.median < GOAL_MS, kept))
    reached = any(step.rate >= 0.99 * GOAL_RATE for step in fast)
    wanted = goal(f"{GOAL_RATE:,} positions/s with a p99 below {GOAL_MS} ms", reached).capitalize()
    late = sum(step.late > LATE_MS for step in steps)
    busy = f" In {late} of {len(steps)} steps the machine was too busy: they say little of the gateway."
    if not kept:
        return f"Not even the first step was kept up. {wanted}.{busy if late else ''}"
    best = max(kept, key=lambda step: step.rate)
    claim = (
        f"Highest rate kept up: **{best.rate:,.0f} positions/s**, with a p99 of {best.p99:.1f} ms. {wanted}."
    )
    if fast:
        claim += f" The p99 was below {GOAL_MS} ms at every step up to {fast[-1].rate:,.0f} positions/s."
    claim += busy if late else ""
    if not kept[-1].swarm_kept_up:
        claim += " Then the robots' process could not send faster: where the gateway ends is not measured."
    elif len(kept) == len(STEPS):
        claim += f" No higher one was tried: a robot may send {MOST_A_SECOND:g} messages a second."
    return claim


def _told(measured: Measured) -> Measured:
    print(measured, file=sys.stderr, flush=True)
    return measured


def _both(windows: list[list[float | None]]) -> list[str]:
    """Return the medians and the 99th percentiles of some windows."""
    told = []
    for found in zip(*windows, strict=True):
        known = [value for value in found if value is not None]
        told.append(f"{spread(known):.1f}" if len(known) == len(found) else "–")
    return told


def site_with_room(folder: Path, robots: int = 0) -> Path:
    """Return the sample site, copied into ``folder``, with limits that let a crowd in from one address, or so
    many ``robots``."""
    site = folder / "site"
    site.mkdir(exist_ok=True)
    shutil.copy(SITE / "site.gpkg", site)
    limits = f"\n[limits]\nrobots = {robots}\nper_address = {robots}\n" if robots else LIMITS
    (site / "site.toml").write_text((SITE / "site.toml").read_text("utf-8") + limits, "utf-8")
    return site


@contextmanager
def serving(peer: str = "") -> Iterator[tuple[int, int]]:
    with tempfile.TemporaryDirectory() as name:
        folder, pinned = Path(name), ["taskset", "-c", str(SERVER_CORE)]
        with Processes(folder / "logs") as processes:
            if peer:
                command = [*pinned, sys.executable, HERE / "plain_fanout.py", peer]
                process = processes.start("server", command, env=MALLOC)
                port = processes.wait_for_line("server", r"listening on ws://\S+:(\d+)", 60).group(1)
                yield process.pid, int(port)
            else:
                url = f"sqlite:///{folder}/fleet.db"
                served = serve(processes, site_with_room(folder), url, env=MALLOC, through=pinned)
                yield served.process.pid, served.port
