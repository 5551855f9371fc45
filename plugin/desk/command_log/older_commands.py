"""Commands of before this desk came: asked of the gateway, and what came of it told."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.PyQt.QtCore import QObject

from ....robot_bridge.messages import GetCommands
from ...errors import FleetError
from ...language import tr, tr_count
from ...wire.outbox import Answer
from .. import command_book
from ..desk import Desk
from ..orders import SLOW_AFTER

OLDER = 1000
"""Commands that are asked for at once."""
MOST_ASKED = 20
"""Robots that are asked for one by one; of more of them the commands of all are."""


@dataclass
class Wish:
    """One press of the button: the commands ``known`` by then, and what its ``waiting`` answers told."""

    known: frozenset[str]
    asked_at: float
    """Monotonic seconds."""
    waiting: int = 0
    came: int = 0
    """Commands that were not known and are in the book now."""
    ends_here: bool = False
    """Whether there may be older ones that the log does not reach."""
    is_refused: bool = False
    is_overdue: bool = False
    """Whether it was told that the gateway does not answer."""


class OlderCommands(QObject):
    """Asks for the newest commands of robots, among which are older ones than the desk was told by itself."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._wishes: dict[str, Wish] = {}
        """By the keys of the questions that are not answered yet."""
        desk.answered.connect(self._answered)
        desk.pulled.connect(self._watch)
        desk.site_changed.connect(self._site_changed)

    def ask(self, robots: frozenset[str] | None) -> None:
        """Ask for the commands of ``robots``, None for all."""
        wish = Wish(frozenset(report.command for report in self._desk.book), self._desk.clock())
        try:
            # Of very many robots the newest commands of all will do: the log holds no more.
            for robot in sorted(robots) if robots and len(robots) <= MOST_ASKED else [None]:
                self._wishes[self._desk.inquire(GetCommands(robot, OLDER), lasting=True)] = wish
                wish.waiting += 1
        except FleetError as error:
            wish.is_refused = True
            self._desk.complained.emit(str(error))
            return
        # What is asked once more need not be told of twice, should the gateway answer after all.
        self._wishes = {key: one for key, one in self._wishes.items() if not one.is_overdue}

    def _answered(self, answer: Answer) -> None:
        wish = self._wishes.pop(answer.order.key, None)
        if wish is None:
            return
        wish.waiting -= 1
        if answer.error is not None:
            if not wish.is_refused:
                self._desk.complained.emit(tr("Older commands: {why}", why=answer.error))
            wish.is_refused = True
        else:
            self._look_at(_commands_in(answer), wish)
        if wish.waiting == 0 and not wish.is_refused:
            self._desk.noted.emit(_in_words(wish))

    def _watch(self) -> None:
        """Say so of a wish that waits for its answers too long, be it that the link is lost."""
        now = self._desk.clock()
        late = {
            id(wish): wish
            for wish in self._wishes.values()
            if not wish.is_overdue and now - wish.asked_at > SLOW_AFTER
        }
        for wish in late.values():
            wish.is_overdue = True
            self._desk.complained.emit(
                tr(
                    "Older commands: the gateway has not answered for {seconds:g} s. Press Older to ask once "
                    "more.",
                    seconds=SLOW_AFTER,
                )
            )

    def _site_changed(self) -> None:
        if len(self._desk.book) == 0:
            # Another gateway's robots are here now: what was asked of the one before is nobody's wish.
            self._wishes.clear()

    def _look_at(self, told: list[str], wish: Wish) -> None:
        # The book has taken them in by now, and let go of the oldest where it was full.
        kept = [command for command in told if command in self._desk.book]
        wish.came += sum(command not in wish.known for command in kept)
        wish.ends_here = wish.ends_here or len(told) >= OLDER or len(kept) < len(told)


def _commands_in(answer: Answer) -> list[str]:
    """Return the ids in an answer; the wire has read its commands before."""
    return [values["command"] for values in (answer.result or {}).get("commands", ())]


def _in_words(wish: Wish) -> str:
    came = (
        tr_count(wish.came, "1 older command came.", "%n older commands came.")
        if wish.came
        else tr("No older commands came.")
    )
    if wish.ends_here:
        end = tr(
            "The log reaches no further back: the newest {asked} of each chosen robot, or of all, are asked "
            "for, and {kept} kept. Older ones are in the gateway's database.",
            asked=OLDER,
            kept=command_book.MOST_COMMANDS,
        )
    else:
        end = tr("The gateway knows no others.")
    return f"{came} {end}"
