"""The part on one gateway alone: its processor time beside that of an earlier revision, by turns."""

from __future__ import annotations

import itertools
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean

from benchmarks.clock import Spread, spread, table
from benchmarks.load import MALLOC, SERVER_CORE, site_with_room
from benchmarks.load import SWARM_CORE as LOADING_CORE
from benchmarks.page import Part, goal
from benchmarks.trial import size
from tests.support.fleet import Served, serve
from tests.support.operators import Desk, open_desk
from tests.support.processes import Processes
from tests.support.robots.robot_wires import RobotWire
from tools.plugin_files import ROOT

PEER = os.environ.get("PEER", "2a3f103a")
"""The revision beside which this one is measured: the last before several gateways could serve a fleet."""
ROUNDS, QUARTETS = size((3, 25), (1, 2))
TURNS = "now", "then", "then", "now"
ROBOTS, OPERATORS, OPERATOR_RATE = size(50, 5), 5, 5.0
POSITIONS, COMMANDS, READIES = size((1000, 20, 20), (100, 5, 5))
"""in each turn."""
ANSWER_WITHIN = 60.0
MESSAGES_PER_S = 1e5
"""that a desk and a robot may send: as fast as it goes."""
MORE = 0.02
"""by which this revision may be slower."""
LOADS = {
    "position": "a position of a robot",
    "command": "a command, from the desk to reached",
    "ready": "a robot that connects, says Ready, has its map and leaves",
}

TEXT = """\
One gateway on SQLite of this revision, and one of {peer}, before several gateways could serve a fleet:
the same Python and libraries, one core for both, the other one for who loads them. In each of {rounds}
rounds both are started anew, and take the same load by turns, {quartets} times this one, the other one
twice, this one: in each turn {positions} positions of {robots} robots, with {operators} operators at
{operator_rate:g} Hz; {commands} commands, one after the other; {readies} robots that connect one after
the other. Figures are the gateway's processor time for each, as the kernel counts it in nanoseconds; the
ratio is that of four turns, this revision over the other, and behind it how far its median may be off (a
standard error). Other work on the machine falls on both.

{figures}

This revision, worst of the three: {worst:.3f} times the processor time ({goal}).{doubt}
"""


@dataclass
class Side:
    """One of the two gateways with everybody at it."""

    served: Served
    desk: Desk
    robots: list[RobotWire]
    numbers: Iterator[int]

    def position(self) -> float:
        """Return the gateway's seconds for each position."""
        steps = range(POSITIONS // ROBOTS)
        at, used = time.time(), seconds_of(self.served.process.pid)
        for place, step in itertools.product(range(ROBOTS), steps):
            x = 20.0 + (next(self.numbers) % 1000) * 0.05
            self.robots[place].tell(
                "SendPos", {"x": x, "y": 8.0, "theta": 0.5, "v": 1.0, "t": at + step / 1000}
            )
        # A connection answers a ping when it has dealt with what came before.
        for answered in [robot.connection.ping() for robot in self.robots]:
            if not answered.wait(ANSWER_WITHIN):
                raise RuntimeError("a gateway does not answer: is it more than a robot may send?")
        return (seconds_of(self.served.process.pid) - used) / POSITIONS

    def command(self) -> float:
        """Return its seconds for each command."""
        return self._each(self._command, COMMANDS)

    def ready(self) -> float:
        """Return its seconds for each robot that comes and goes."""
        return self._each(self._come_and_go, READIES)

    def _each(self, action: Callable[[], None], times: int) -> float:
        used = seconds_of(self.served.process.pid)
        for _ in range(times):
            action()
        return (seconds_of(self.served.process.pid) - used) / times

    def _command(self) -> None:
        number = next(self.numbers)
        place = number % ROBOTS
        robot, name, x = self.robots[place], f"robot-{place}", 20.0 + number // ROBOTS % 2 * 2.0
        self.desk.send(f"command-{number:06d}", name, "SetPosEnd", x=x, y=8.0)
        robot.hear("SetPosEnd")
        robot.tell("SendPos", {"x": x, "y": 8.0, "theta": 0.0, "v": 0.0})
        self.desk.wait_for_step(f"command-{number:06d}", "reached")

    def _come_and_go(self) -> None:
        number = next(self.numbers)
        with RobotWire(f"{self.served.address}/robot?robot=guest-{number % ROBOTS}") as robot:
            robot.plug_in(number + 1)


def seconds_of(pid: int) -> float:
    """Return the processor time that a process has used, finer than the ticks of :func:`cpu_seconds`."""
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return sum(int((task / "schedstat").read_text(encoding="ascii").split()[0]) for task in tasks) / 1e9


def measure(_data: Path) -> Part:
    """Measure both revisions by turns."""
    found: dict[str, dict[str, list[float]]] = {load: {"now": [], "then": []} for load in LOADS}
    os.sched_setaffinity(0, {LOADING_CORE} & os.sched_getaffinity(0) or os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory(prefix="fleet-before-") as name:
        tree = _tree(Path(name), PEER)
        for number in range(ROUNDS):
            folder = Path(name) / f"round-{number}"
            folder.mkdir()
            with ExitStack() as stack:
                sides = {
                    "now": _side(stack, folder / "now", ROOT),
                    "then": _side(stack, folder / "then", tree),
                }
                for load in LOADS:
                    for side in sides.values():
                        getattr(side, load)()
                    for _ in range(QUARTETS):
                        _add_quartet(found[load], sides, load)
            print({load: _ratio(found[load]) for load in LOADS}, file=sys.stderr, flush=True)
    return report(found)


def _add_quartet(found: dict[str, list[float]], sides: dict[str, Side], load: str) -> None:
    turns = [(which, getattr(sides[which], load)()) for which in TURNS]
    for which, seconds in found.items():
        seconds.append(fmean(value for name, value in turns if name == which))


def _tree(folder: Path, revision: str) -> Path:
    """Return a new folder with the sources of ``revision``."""
    tree = folder / "tree"
    tree.mkdir()
    archive = subprocess.run(
        ["git", "-C", str(ROOT), "archive", revision, "robot_bridge"], stdout=subprocess.PIPE, check=False
    )
    if archive.returncode:
        sys.exit(f"bench: git has no revision {revision} here; name another one with PEER=")
    subprocess.run(["tar", "-x", "-C", str(tree)], input=archive.stdout, check=True)
    return tree


def _side(stack: ExitStack, folder: Path, tree: Path) -> Side:
    folder.mkdir()
    processes = stack.enter_context(Processes(folder / "logs"))
    # The folder that it is started in is the first in which Python looks for it.
    through = ["env", "-C", str(tree), "taskset", "-c", str(SERVER_CORE)]
    site = site_with_room(folder)
    with (site / "site.toml").open("a", encoding="utf-8") as settings:
        settings.writelines(f"{who}_messages_per_s = {MESSAGES_PER_S}\n" for who in ("desk", "robot"))
    served = serve(processes, site, f"sqlite:///{folder}/fleet.db", env=MALLOC, through=through)
    desk = stack.enter_context(open_desk(served.address))
    for _ in range(OPERATORS):
        operator = stack.enter_context(open_desk(served.address))
        operator.ask("subscribe", {"rate": OPERATOR_RATE, "form": "columns"})
    robots = []
    for number in range(ROBOTS):
        robot = stack.enter_context(RobotWire(f"{served.address}/robot?robot=robot-{number}"))
        robot.plug_in(number + 1)
        robot.tell("SendPos", {"x": 24.0, "y": 8.0, "theta": 0.0, "v": 0.0})
        robots.append(robot)
    return Side(served, desk, robots, itertools.count(1))


def _ratio(seconds: dict[str, list[float]]) -> Spread:
    """Return by how much this revision takes longer."""
    return spread(now / then for now, then in zip(seconds["now"], seconds["then"], strict=True))


def _error(ratio: Spread, count: int) -> float:
    """Return the standard error of a median, by the quartiles of ``count`` values."""
    return 0.93 * (ratio.high - ratio.low) / math.sqrt(count)


def _doubt(found: dict[str, dict[str, list[float]]]) -> str:
    """Return what is to be said where the machine was too busy to tell."""
    highest = []
    for seconds in found.values():
        ratio = _ratio(seconds)
        highest.append(ratio.median + 2 * _error(ratio, len(seconds["now"])))
    if max(highest) <= 1 + MORE:
        return ""
    return (
        f" Two standard errors allow for up to {max(highest):.3f}: the machine was too busy to rule that out."
    )


def report(found: dict[str, dict[str, list[float]]]) -> Part:
    """Return the part of the page."""
    ratios = {load: _ratio(seconds) for load, seconds in found.items()}
    worst = max(ratio.median for ratio in ratios.values())
    rows = [
        [
            LOADS[load],
            *(f"{spread(seconds[which]).scaled(1e6):.0f}" for which in ("then", "now")),
            f"{ratios[load]:.3f}",
            f"{_error(ratios[load], len(seconds['now'])):.3f}",
        ]
        for load, seconds in found.items()
    ]
    text = TEXT.format(
        **{"peer": PEER, "rounds": ROUNDS, "robots": ROBOTS, "operators": OPERATORS, "quartets": QUARTETS},
        **{"operator_rate": OPERATOR_RATE, "positions": POSITIONS, "commands": COMMANDS, "readies": READIES},
        figures=table(["", f"{PEER}, µs", "this revision, µs", "ratio", "±"], rows),
        worst=worst,
        doubt=_doubt(found),
        goal=goal(f"at most {1 + MORE:g}", worst <= 1 + MORE),
    )
    return Part("One gateway, beside an earlier revision", text, settings=MALLOC)
