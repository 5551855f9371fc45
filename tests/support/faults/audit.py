"""What became of everything: the database against what desks were told and robots wrote down."""

from __future__ import annotations

import hashlib
import itertools
import statistics
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy import Connection, text

from robot_bridge.gateway.storage.database import run_once
from tests.support.faults.desk import ENDS, Ledger
from tests.support.faults.yard import GATEWAY_KILLED, ROBOTS_KILLED, Death, Fault, Yard

YOUNG_S = 2.0
"""seconds before a gateway's death in which positions may be lost."""
NOTICED_WITHIN = 0.5
"""seconds after it in which a robot may still have written into a dead connection."""
LAST_WORDS_S = 0.5
"""seconds before the death of a robot in which what it said may go down with its connection, unread."""
CLOCK_S = 0.1
"""seconds by which two processes of this machine may disagree on what came first."""
STOP_KNOWN_S = 2.0
"""seconds that gateways may differ on whether a stop is in force."""
LOST_YOUNG = f"... lost, told at most {YOUNG_S:g} s before a gateway was killed"
LOST_WITH_ROBOT = f"... lost, told at most {LAST_WORDS_S:g} s before the robot itself was killed"
ORDER = ("queued", "delivered", "acknowledged", "reached")


@dataclass
class Stored:
    """What the database holds in the end."""

    commands: dict[str, Any]
    steps: dict[str, list[Any]]
    observations: list[Any]
    positions: Counter[tuple[str, float]]
    waiting: list[Any]


@dataclass
class Deaths:
    """When gateways were killed, and robots by their names."""

    gateways: Sequence[Death]
    robots: Mapping[str, Sequence[Death]]


@dataclass
class Findings:
    """Counts by their names, and every sentence about something that is wrong."""

    counts: Counter[str] = field(default_factory=Counter)
    back_after: list[float] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)

    def lines(self) -> str:
        """Return all of it as lines."""
        lines = [f"{name}: {count}" for name, count in self.counts.items()]
        lines.append(f"seconds from a fault to the next command reached: {self.back}")
        return "\n".join([*lines, *(f"WRONG: {sentence}" for sentence in self.wrong)])

    @property
    def back(self) -> str:
        """How long it took until all went on, in words."""
        if not self.back_after:
            return "not measured"
        return f"{statistics.median(self.back_after):.1f}, at most {max(self.back_after):.1f}"


def audit(yard: Yard) -> Findings:
    """Judge what happened in a yard that has finished."""
    stored = run_once(yard.place.url, load_stored)
    deaths = Deaths(yard.gateway_ends, yard.robot_ends())
    findings = judged(yard.ledger, yard.faults, stored, list(yard.journals()), deaths)
    findings.wrong += yard.said("Traceback")[:3]
    findings.back_after = list(_recoveries(yard, stored))
    return findings


def judged(
    ledger: Ledger,
    faults: Sequence[Fault],
    stored: Stored,
    lines: Sequence[dict[str, Any]],
    deaths: Deaths,
    stops: Sequence[tuple[float, float]] = (),
) -> Findings:
    """Judge what is stored by what desks were told, what was done, and what robots wrote down.

    ``stops`` are the times of emergency stops and of their ends: what robots have not read is withdrawn.
    """
    findings = Findings(wrong=list(ledger.wrong))
    lines = sorted(lines, key=lambda line: float(line["at"]))
    findings.wrong += [f"robot {line['robot']}: {line['text']}" for line in lines if line["what"] == "wrong"]
    findings.wrong += [f"{op} of or for robot {robot} still waits" for robot, op in stored.waiting]
    findings.counts.update(Counter(fault.what for fault in faults))
    _judge_commands(ledger, stored, _acts(lines), findings, stops)
    _judge_observations(faults, stored, lines, findings)
    _judge_positions(faults, stored, lines, deaths, findings)
    return findings


def load_stored(connection: Connection) -> Stored:
    """Return what a database holds; to be run when nothing is written any more."""

    def rows(query: str) -> list[Any]:
        return list(connection.execute(text(query)))

    steps = defaultdict(list)
    for step in rows("select command, state, at, reason from command_steps order by id"):
        steps[step.command].append(step)
    return Stored(
        {row.id: row for row in rows("select id, robot, op, state, sa_id from commands")},
        steps,
        rows("select robot, object, image from observations"),
        Counter((row.robot, row.device_time) for row in rows("select robot, device_time from trajectories")),
        rows("select robot, op from sa where op in ('SetPosEnd', 'SetPath', 'Abort')")
        + rows("select robot, op from rr"),
    )


Acts = Mapping[str, list[dict[str, Any]]]
"""What robots did: by the id of the command, or by robot for Aborts."""


def _acts(lines: Iterable[dict[str, Any]]) -> Acts:
    acts: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for line in lines:
        if line["what"] == "acted":
            name = line["robot"] if line["op"] == "Abort" else f"{line['robot']}-{line['number']:06d}"
            acts[name].append(line)
    return acts


def _judge_commands(
    ledger: Ledger, stored: Stored, acts: Acts, findings: Findings, stops: Sequence[tuple[float, float]]
) -> None:
    counts = findings.counts
    counts["commands told queued"] = len(ledger.told)
    counts["asked again for want of an answer"] = ledger.repeated
    counts["refused with an error"] = len(ledger.refused)
    for id in ledger.told:
        command = stored.commands.get(id)
        if command is None:
            findings.wrong.append(f"command {id} was told queued and is not in the database")
            continue
        steps = stored.steps[id]
        withdrawn = _is_stopped(steps, stops)
        findings.wrong += [f"command {id}: {fault}" for fault in _life_faults(command, steps, withdrawn)]
        did = acts[id] if command.op != "Abort" else _same_message(acts[command.robot], command.sa_id)
        if did or not withdrawn:
            findings.wrong += [f"command {id}: {fault}" for fault in _act_faults(command, steps, did, acts)]
        counts[f"... {command.state}"] += 1
        counts["acted on"] += bool(did)
        counts["acted on again by a robot that had forgotten it"] += len({act["life"] for act in did}) > 1
    unknown = {id for id in acts if "-" in id} - ledger.told.keys() - ledger.refused.keys()
    findings.wrong += [f"command {id} was acted on and the desk has no answer for it" for id in unknown]


def _same_message(acts: list[dict[str, Any]], sa_id: int) -> list[dict[str, Any]]:
    return [act for act in acts if act["id"] == sa_id]


def _is_stopped(steps: list[Any], stops: Sequence[tuple[float, float]]) -> bool:
    """Tell whether a command ended aborted, or superseded by another Abort, of an emergency stop."""
    if not steps or steps[-1].state not in ("aborted", "superseded"):
        return False
    first, last = steps[0].at - STOP_KNOWN_S, steps[-1].at + CLOCK_S
    return any(at <= last and first <= end for at, end in stops)


def _life_faults(command: Any, steps: list[Any], withdrawn: bool = False) -> Iterator[str]:
    """Yield what a command's log says that cannot be, of one that was ``withdrawn`` by an emergency stop."""
    states = [step.state for step in steps]
    if not states or states[0] != "queued":
        yield f"its log begins with {states[:1]}"
    if command.state not in ENDS or states[-1:] != [command.state]:
        yield f"it is {command.state}, and its log ends with {states[-1:]}"
    for before, after in itertools.pairwise(states):
        back = before in ORDER and after in ORDER and ORDER.index(after) < ORDER.index(before)
        if (before in ENDS and after != before) or back:
            yield f"{after} after {before}"
    superseded = withdrawn and command.op == "Abort" and command.state == "superseded"
    if command.state not in ("reached", "aborted") and not superseded:
        yield f"it is {command.state}: {steps[-1].reason}"


def _act_faults(command: Any, steps: list[Any], did: list[dict[str, Any]], acts: Acts) -> Iterator[str]:
    """Yield where the log of a command and what its robot did do not agree."""
    lives = [act["life"] for act in did]
    if len(lives) != len(set(lives)):
        yield f"acted on {len(did)} times, in lives {lives}"
    # Under one id it was never sent again: the robot died before it could say that it had read it.
    sent_again = any("started anew" in (step.reason or "") for step in steps)
    if len({act["id"] for act in did}) > 1 and not sent_again:
        yield f"acted on in lives {lives}, and the log does not say that it was sent again"
    # It is delivered before it is sent: where the database was too slow for that, an Abort takes it back.
    without_act = ("acknowledged", "reached") if command.state == "aborted" else ORDER[1:]
    for step in steps:
        if step.state in without_act and not did:
            yield f"{step.state}, and the robot never acted on it"
        elif step.state in ("acknowledged", "reached") and step.at < did[0]["at"] - CLOCK_S:
            yield f"{step.state} {did[0]['at'] - step.at:.2f} s before the robot acted on it"
    if command.state == "aborted" and did:
        stops = [act for act in acts[command.robot] if act["at"] >= did[-1]["at"]]
        if not stops:
            yield "aborted, and the robot acted on it after the Abort"


def _judge_observations(
    faults: Iterable[Fault], stored: Stored, lines: Iterable[dict[str, Any]], findings: Findings
) -> None:
    images: dict[str, list[str | None]] = defaultdict(list)
    for row in stored.observations:
        images[row.object].append(None if row.image is None else hashlib.sha256(row.image).hexdigest())
    for object, found in images.items():
        if len(found) > 1:
            findings.wrong.append(f"object {object} is stored {len(found)} times")
    for line in lines:
        if line["what"] == "accepted":
            findings.counts["images accepted" if line["image"] else "objects accepted"] += 1
            if images.get(line["object"]) != [line["image"]]:
                findings.wrong.append(
                    f"object {line['object']} was accepted {_beside(faults, line['at'])} and is not stored "
                    f"as it was told, but {images.get(line['object'], 'not at all')}"
                )


def _beside(faults: Iterable[Fault], at: float) -> str:
    """Return in words when that was."""
    nearest = min(faults, key=lambda fault: abs(at - fault.at), default=None)
    return "" if nearest is None else f"{at - nearest.at:+.2f} s from '{nearest.what}'"


def _judge_positions(
    faults: Iterable[Fault],
    stored: Stored,
    lines: Iterable[dict[str, Any]],
    deaths: Deaths,
    findings: Findings,
) -> None:
    counts = findings.counts
    for line in lines:
        if line["what"] != "pose":
            continue
        counts["positions told"] += 1
        if (line["robot"], line["t"]) in stored.positions:
            counts["... stored"] += 1
        elif _is_beside(line["t"], deaths.gateways, YOUNG_S, NOTICED_WITHIN):
            counts[LOST_YOUNG] += 1
        elif _is_beside(line["t"], deaths.robots.get(line["robot"], ()), LAST_WORDS_S, 0.0):
            counts[LOST_WITH_ROBOT] += 1
        else:
            findings.wrong.append(f"position of {line['robot']} told {_beside(faults, line['t'])} is lost")
    counts["... stored twice"] = sum(count - 1 for count in stored.positions.values())


def _is_beside(at: float, deaths: Iterable[Death], before: float, after: float) -> bool:
    return any(death.since - before <= at <= death.by + after for death in deaths)


def _recoveries(yard: Yard, stored: Stored) -> Iterator[float]:
    """Yield the seconds from each fault to the next command that was reached, by those whom it hit."""
    reached = sorted(
        (step.at, id.split("-")[0])
        for id, steps in stored.steps.items()
        for step in steps
        if step.state == "reached"
    )
    for fault in yard.faults:
        # A step has the time when it was begun; nothing is begun while there is no gateway.
        begin = fault.at if fault.what == GATEWAY_KILLED else fault.until
        hit = yard.crews[-1].robots if fault.what == ROBOTS_KILLED else yard.place.robot_urls
        after = [at - fault.at for at, robot in reached if at > begin and robot in hit]
        if after:
            yield after[0]
