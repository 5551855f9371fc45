"""The part on one gateway alone: its processor time beside that of an earlier revision, by turns."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from benchmarks.clock import Spread, spread, table
from benchmarks.load import MALLOC, SERVER_CORE, SWARM_CORE, site_with_room
from benchmarks.page import Part, goal
from benchmarks.swarm import Plan, Swarm, cpu_seconds
from benchmarks.trial import size
from tests.support.fleet import Served, serve
from tests.support.operators import Desk, open_desk
from tests.support.processes import Processes
from tests.support.robots.robot_wires import RobotWire
from tools.plugin_files import ROOT

PEER = os.environ.get("PEER", "2a3f103a")
"""The revision beside which this one is measured: the last before several gateways could serve a fleet."""
ROUNDS = size(5, 1)
TURNS = "now", "then", "then", "now"
ROBOTS, RATE, OPERATORS, SECONDS = size((200, 10.0, 5, 4.0), (20, 10.0, 2, 1.0))
DRIVEN, COMMANDS, READIES = size((10, 300, 200), (2, 10, 10))
MORE = 0.02
"""by which this revision may be slower."""
LOADS = {
    "position": "a position, told to operators",
    "command": "a command, from the desk to reached",
    "ready": "a robot that connects, says Ready, has its map and leaves",
}

TEXT = """\
One gateway on SQLite of this revision, and one of {peer}, before several gateways could serve a fleet:
the same Python and libraries, one core for both, the other one for who loads them. In each of {rounds}
rounds both are started anew, and take the same load by turns, this one first and last: positions of
{robots} robots, {rate:g} a second each, with {operators} operators, for {seconds:g} s; {commands}
commands to {driven} robots, one after the other; {readies} robots that connect one after the other. The
seconds are of the gateway's processor time for each, the ratio that of two turns that followed one
another, this revision over the other.

{figures}

This revision, worst of the three: {worst:.3f} times the processor time ({goal}).
"""


@dataclass
class Side:
    """One of the two gateways with everybody at it."""

    served: Served
    swarm: Swarm
    desk: Desk
    robots: list[RobotWire]
    numbers: Iterator[int]

    def position(self) -> float:
        """Return the gateway's seconds for each position."""
        seen = self.swarm.window(RATE, SECONDS)
        return seen.cpu / seen.rate

    def command(self) -> float:
        """Return its seconds for each command."""
        return self._each(self._command, COMMANDS)

    def ready(self) -> float:
        """Return its seconds for each robot that comes and goes."""
        return self._each(self._come_and_go, READIES)

    def _each(self, action: Callable[[], None], times: int) -> float:
        action()
        used = cpu_seconds(self.served.process.pid)
        for _ in range(times):
            action()
        return (cpu_seconds(self.served.process.pid) - used) / times

    def _command(self) -> None:
        number = next(self.numbers)
        place = number % DRIVEN
        robot, name, x = self.robots[place], f"driven-{place}", 20.0 + number // DRIVEN % 2 * 2.0
        self.desk.send(f"command-{number:06d}", name, "SetPosEnd", x=x, y=8.0)
        robot.hear("SetPosEnd")
        robot.tell("SendPos", {"x": x, "y": 8.0, "theta": 0.0, "v": 0.0})
        self.desk.wait_for_step(f"command-{number:06d}", "reached")

    def _come_and_go(self) -> None:
        number = next(self.numbers)
        with RobotWire(f"{self.served.address}/robot?robot=guest-{number % DRIVEN}") as robot:
            robot.plug_in(number + 1)


def measure(_data: Path) -> Part:
    """Measure both revisions by turns."""
    found: dict[str, dict[str, list[float]]] = {load: {"now": [], "then": []} for load in LOADS}
    with tempfile.TemporaryDirectory(prefix="fleet-before-") as name:
        tree = _tree(Path(name), PEER)
        for number in range(ROUNDS):
            folder = Path(name) / f"round-{number}"
            folder.mkdir()
            with ExitStack() as stack:
                sides = {
                    which: _side(stack, folder / which, of) for which, of in (("now", ROOT), ("then", tree))
                }
                for load, which in itertools.product(LOADS, TURNS):
                    found[load][which].append(getattr(sides[which], load)())
            print({load: _ratio(found[load]) for load in LOADS}, file=sys.stderr, flush=True)
    return report(found)


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
    served = serve(
        processes, site_with_room(folder), f"sqlite:///{folder}/fleet.db", env=MALLOC, through=through
    )
    plan = Plan("127.0.0.1", served.port, served.process.pid, ROBOTS, OPERATORS)
    swarm = stack.enter_context(Swarm(plan, SWARM_CORE))
    desk = stack.enter_context(open_desk(served.address))
    robots = []
    for number in range(DRIVEN):
        robot = stack.enter_context(RobotWire(f"{served.address}/robot?robot=driven-{number}"))
        robot.plug_in(number + 1)
        robot.tell("SendPos", {"x": 24.0, "y": 8.0, "theta": 0.0, "v": 0.0})
        robots.append(robot)
    return Side(served, swarm, desk, robots, itertools.count(1))


def _ratio(seconds: dict[str, Sequence[float]] | dict[str, list[float]]) -> Spread:
    """Return by how much this revision takes longer, of the turns that followed one another."""
    return spread(now / then for now, then in zip(seconds["now"], seconds["then"], strict=True))


def report(found: dict[str, dict[str, list[float]]]) -> Part:
    """Return the part of the page."""
    ratios = {load: _ratio(seconds) for load, seconds in found.items()}
    worst = max(ratio.median for ratio in ratios.values())
    rows = [
        [
            LOADS[load],
            *(f"{spread(seconds[which]).scaled(1e6):.0f}" for which in ("then", "now")),
            f"{ratios[load]:.3f}",
        ]
        for load, seconds in found.items()
    ]
    text = TEXT.format(
        **{"peer": PEER, "rounds": ROUNDS, "robots": ROBOTS, "rate": RATE, "operators": OPERATORS},
        **{"seconds": SECONDS, "commands": COMMANDS, "driven": DRIVEN, "readies": READIES, "worst": worst},
        figures=table(["", f"{PEER}, µs", "this revision, µs", "ratio"], rows),
        goal=goal(f"at most {1 + MORE:g}", worst <= 1 + MORE),
    )
    return Part("One gateway, beside an earlier revision", text, settings=MALLOC)
