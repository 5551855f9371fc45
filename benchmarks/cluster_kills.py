"""The part on kills: gateways, NATS servers and PostgreSQL die a hundred times under commands and stops."""

from __future__ import annotations

import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

from benchmarks.clock import spread, table
from benchmarks.cluster_crowd import HEARD_WITHIN
from benchmarks.cluster_onlookers import Plan as Onlookers
from benchmarks.cluster_positions import Fleet
from benchmarks.page import Part, goal
from benchmarks.trial import size
from robot_bridge.core.reconnection import ROBOT_PACE
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.faults.audit import Findings
from tests.support.faults.cluster_yard import (
    AGAIN,
    DATABASE_KILLED,
    DESKS,
    NATS_KILLED,
    STARTED_AGAIN_S,
    STOP_EVERY_S,
    ClusterYard,
    Stop,
)
from tests.support.faults.desk import SHARE_ABORTED
from tests.support.faults.yard import GATEWAY_KILLED
from tests.support.nats_server import NatsCluster

GATEWAYS, ROBOTS = 4, 40
KILLS = {GATEWAY_KILLED: size(60, 2), NATS_KILLED: size(20, 1), DATABASE_KILLED: size(20, 1)}
WORK_S = 0.5, 3.0
AFTERWARDS_S = 1.5
LONGEST_SEED = 10**6
MANY, MANY_RATE, DESK_RATE = size(1250, 20), 0.5, 2.0
"""robots of each gateway, how often each says where it is in a second, and frames that a desk has of all."""
BACK_S, SETTLE_S = 5.0, size(12.0, 4.0)
"""seconds within which all robots of a gateway that died are to be heard again, and those before it dies."""

TEXT = """\
{gateways} gateways of one fleet on PostgreSQL, which waits for its disk, and three NATS servers as a
cluster. {robots} robots on WebSocket go to the next gateway when theirs is gone, and write down every
message that they act on with its id; {desks} desks send them numbered commands without pause,
{aborted:.0f} % of them followed by an Abort, ask again under the same id where no answer comes, and go to
the next gateway, too. A supervisor makes an emergency stop every {stop_least:g} to {stop_most:g} s at any
gateway, waits until every robot has heard of it, and ends it. Meanwhile something is killed (SIGKILL)
every {least:g} to {most:g} s, at random (seed {seed}), and started again after up to {again:g} s; a
gateway only while another one is up. Then the database is held against what desks were told and robots
wrote down.

{figures}

What has to hold: each command that a desk was told is queued has ended, was acted on once or, where it
was withdrawn before the robot read it, not at all, and its log agrees with what the robot wrote down. No
command was acted on of which a desk was told that it was not done. Every robot heard of every stop, the
stops made while PostgreSQL was away included, and between that and the asking for its end it was sent
nowhere.

Wrong in all of this: {wrong} ({goal}).

{many} robots, dealt out evenly over {gateways} gateways and one NATS server, say where they are {rate:g}
times a second, and after each Ready; one gateway is killed, and its robots go on at the others as the
reference robot does: they try theirs once more after {again_s:g} s, and one of the others {between:g} s
later. {back}
"""


class Killed(NamedTuple):
    """What came of it."""

    findings: Findings
    stops: Sequence[Stop]
    minutes: float


def measure(_data: Path) -> Part:
    """Kill everything, and then one gateway with many robots."""
    seed = random.randrange(LONGEST_SEED)
    print(f"seed {seed}", file=sys.stderr)
    try:
        killed = _kill_all(seed)
        print(killed.findings.lines(), file=sys.stderr, flush=True)
    except StageError as error:
        sys.exit(f"bench: {error}")
    back = None
    try:
        back = _lose_one_of_many()
    except (StageError, RuntimeError) as error:
        print(error, file=sys.stderr)
    return part(seed, killed, back)


def _kill_all(seed: int) -> Killed:
    began = time.monotonic()
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="fleet-kills-")))
        server = stack.enter_context(PostgreSql(durable=True))
        nats = stack.enter_context(NatsCluster(folder / "nats"))
        yard = stack.enter_context(ClusterYard(folder, server, nats, seed, GATEWAYS, ROBOTS))
        ways = {
            GATEWAY_KILLED: yard.kill_gateway,
            NATS_KILLED: yard.kill_nats_server,
            DATABASE_KILLED: yard.kill_database,
        }
        order = [ways[what] for what, times in KILLS.items() for _ in range(times)]
        yard.random.shuffle(order)
        for kill in order:
            yard.work(*WORK_S)
            kill()
        yard.work(AFTERWARDS_S, AFTERWARDS_S)
        yard.finish()
        return Killed(yard.audit(), yard.stopping.stops, (time.monotonic() - began) / 60)


def _lose_one_of_many() -> float:
    """Return the seconds until all robots of a gateway that was killed are heard again at another one."""
    with PostgreSql(durable=True) as database, Fleet(database, GATEWAYS, MANY, follow=True) as fleet:
        plan = Onlookers(fleet.addresses[:1], [{"rate": DESK_RATE, "form": "columns"}])
        desks = fleet.begin("benchmarks.cluster_onlookers", asdict(plan))
        desks.line()
        drive = fleet.drive(0.5, SETTLE_S + HEARD_WITHIN, MANY_RATE, SETTLE_S)
        drive.wait(SETTLE_S)
        since = time.time()
        fleet.kill(GATEWAYS - 1)
        desks.tell(schedule=drive.schedule, heard={"home": GATEWAYS - 1, "since": since})
        return float(desks.line())


def part(seed: int, killed: Killed, back: float | None) -> Part:
    """Return the part of the page."""
    wrong = killed.findings.wrong
    text = TEXT.format(
        **{"gateways": GATEWAYS, "robots": ROBOTS, "desks": DESKS, "aborted": 100 * SHARE_ABORTED},
        **{
            "stop_least": STOP_EVERY_S[0],
            "stop_most": STOP_EVERY_S[1],
            "least": WORK_S[0],
            "most": WORK_S[1],
        },
        **{"again": STARTED_AGAIN_S, "seed": seed, "figures": _figures(killed), "many": GATEWAYS * MANY},
        **{"rate": MANY_RATE, "back": _back(back)},
        **{"again_s": ROBOT_PACE.first_wait, "between": ROBOT_PACE.between},
        wrong=len(wrong) or "nothing",
        goal=goal("nothing", not wrong),
    )
    return Part("Kills", "\n".join([text, *(f"- {sentence}" for sentence in wrong)]), bool(wrong))


def _back(seconds: float | None) -> str:
    wanted = f"at most {BACK_S:g} s"
    if seconds is None:
        return f"They did not all come, or come back: the machine was too busy ({goal(wanted, False)})."
    told = f"A desk elsewhere was told of all of its robots again after {seconds:.1f} s"
    return f"{told} ({goal(wanted, seconds <= BACK_S)})."


def _figures(killed: Killed) -> str:
    counts = killed.findings.counts
    heard = [stop.seconds for stop in killed.stops if stop.heard]
    rows = [
        ["killed: gateways, NATS servers, PostgreSQL", ", ".join(str(counts[what]) for what in KILLS)],
        ["minutes", f"{killed.minutes:.1f}"],
        ["commands and Aborts that desks were told are queued", counts["commands told queued"]],
        ["... acted on", counts["acted on"]],
        ["... reached; aborted", f"{counts['... reached']}; {counts['... aborted']}"],
        ["asked again for want of an answer", counts["asked again for want of an answer"]],
        ["refused: PostgreSQL away, or a stop in force", counts["refused with an error"]],
        ["messages that came again under their id, and were not acted on", counts[AGAIN]],
        ["objects and images that robots were told are taken, each stored once", _objects(counts)],
        ["emergency stops", len(killed.stops)],
        ["a stop until the last robot heard, s; at most", _spread(heard)],
        ["a gateway killed until others had all its robots, s; at most", _spread(killed.findings.back_after)],
    ]
    return table(["", ""], rows)


def _objects(counts: Counter[str]) -> int:
    return counts["objects accepted"] + counts["images accepted"]


def _spread(seconds: Sequence[float]) -> str:
    return f"{spread(seconds):.1f}; {max(seconds):.1f}" if seconds else "–"
