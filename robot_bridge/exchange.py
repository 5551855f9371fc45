"""What comes of robots' requests, and how it is written: answers into SA, and requests out of RR."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Connection

from .messages import Answer, OpAck, SetMap, Start
from .store import answers, requests, trajectories
from .store.answers import AnswerRow
from .store.trajectories import PackedFix

Reader = tuple[str, int, int]
"""A robot, and what it was sent last: the ids of a message and of an urgent one."""

WHOLE_SITE = SetMap(b"")
"""The map of the whole site for a robot that reads no rows itself: what delivers it has the map at hand.

A city's map has megabytes: written, checkpointed and deleted for each robot it keeps all others waiting.
"""


@dataclass(frozen=True)
class Outcome:
    """What comes of a robot's request: its OpAck, an answer, and the kinds of older answers that are void.

    What is ``written`` stands in SA already, and only the request is still to be deleted. ``part``: its
    map is a part of the site, and more of it may have to follow.
    """

    robot: str
    ack: OpAck | None = None
    answer: Answer | None = None
    void: tuple[str, ...] = ()
    written: bool = False
    part: bool = False

    @property
    def admitted(self) -> bool:
        """Tell whether the request was a Ready, and taken."""
        return self.ack is not None and self.ack.ok and self.ack.magic is not None

    def rows(self, *, acks: bool) -> list[tuple[str, Answer]]:
        """Return what is to be written into SA, the OpAck first."""
        if self.written:
            return []
        messages: list[Answer | None] = [self.ack if acks else None, self.answer]
        return [(self.robot, message) for message in messages if message is not None]

    def voided(self) -> tuple[str, ...]:
        """Return the kinds of older answers that are void; a map or a Start is, when there is a newer one."""
        if self.written:
            return ()
        renewed = isinstance(self.answer, (SetMap, Start))
        return (*self.void, type(self.answer).__name__) if renewed else self.void


def rows_of(outcomes: Sequence[Outcome], *, acks: bool) -> list[tuple[str, Answer]]:
    """Return what is to be written into SA; left out is what a later Ready of the same robot makes void.

    A robot that said Ready again and again while nobody read it is given the map of the whole site once.
    """
    void: defaultdict[str, set[str]] = defaultdict(set)
    kept: list[tuple[str, Answer]] = []
    for outcome in reversed(outcomes):
        gone = void[outcome.robot]
        kept += [row for row in reversed(outcome.rows(acks=acks)) if type(row[1]).__name__ not in gone]
        if outcome.admitted:
            gone.update(outcome.voided())
    return kept[::-1]


def finish(
    connection: Connection,
    outcomes: Sequence[Outcome],
    rows: Sequence[tuple[str, Answer]],
    request_ids: Sequence[int],
    fixes: Sequence[PackedFix],
) -> None:
    """Write what comes of requests, and where robots were, and delete the requests."""
    for outcome in outcomes:
        remove_voided(connection, outcome.robot, outcome.voided())
        if request_ids and outcome.admitted and isinstance(outcome.answer, SetMap):
            # It may have come over another link before, and is to read the rows itself from now on.
            answers.fill_maps(connection, outcome.robot, outcome.answer.map)
    answers.add_all(connection, rows)
    trajectories.add(connection, fixes)
    requests.remove(connection, request_ids)


def finish_and_read(
    connection: Connection, outcomes: Sequence[Outcome], rows: Sequence[tuple[str, Answer]], reader: Reader
) -> list[AnswerRow]:
    """Write what comes of requests, and return what then waits for one robot."""
    finish(connection, outcomes, rows, [], [])
    return answers.read(connection, *reader)


def remove_voided(connection: Connection, robot: str, kinds: Sequence[str]) -> None:
    """Delete the robot's answers of ``kinds``; of maps those that nothing waits behind which needs one."""
    others = [kind for kind in kinds if kind != SetMap.__name__]
    if len(others) < len(kinds):
        answers.remove_maps(connection, robot)
    if others:
        answers.remove_kinds(connection, robot, others)


def look(connection: Connection, sent: Sequence[int]) -> tuple[list[requests.RequestRow], set[int]]:
    """Return the oldest requests, and which of the messages ``sent`` still wait to be read."""
    # In this order: a robot deletes what it read before it acknowledges it.
    rows = requests.read(connection)
    return rows, answers.waiting(connection, sent)
