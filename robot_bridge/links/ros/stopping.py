"""How a robot on ROS 2 is stopped: what is said, how often, and when it counts as heard; no I/O.

A stop is three things at once, repeated until they are answered: all goals of its action servers are
canceled, whoever sent them; speed 0 is published; its stop service is called where it has one.
"""

from __future__ import annotations

from collections.abc import Mapping

from .effects import (
    Abilities,
    Action,
    CallStop,
    CancelGoals,
    Effect,
    PublishHere,
    Remark,
    StopEnded,
    ZeroTwist,
)
from .goals import ACTIVE, GoalStatus, Statuses

ASK_AGAIN = 0.5
"""seconds after which goals are canceled, and the service called, once more."""
TWIST_EVERY = 0.1
"""seconds between two messages of speed 0."""
LONGEST = 5.0
"""seconds after which a stop that nobody answered is refused, so that operators see it."""
ASK_SELDOM = 2.0
"""seconds between two attempts after that."""
STANDING = 0.05
"""m/s below which a robot stands."""

REJECTED = 1
"""action_msgs/CancelGoal: ERROR_REJECTED."""


class Stop:
    """One stop of one robot, from the first Abort to its end."""

    def __init__(self, now: float) -> None:
        self._began = now
        self._ask_at = self._twist_at = now
        self._canceled: set[Action] = set()
        self._stopped_by_service = False
        self._stood = 0
        self._service_said = ""
        self.is_over = False
        self.is_refused = False

    def restart(self, now: float) -> None:
        """Give a stop that nobody answered as much time again."""
        self._began, self._ask_at, self.is_refused = now, now, False

    def cancel_answered(self, action: Action, code: int, statuses: Statuses) -> None:
        """Take in what an action server said to canceling all goals; ``statuses`` are its goals'."""
        busy = any(status in ACTIVE and status != GoalStatus.CANCELING for status in statuses.values())
        if code != REJECTED or not busy:
            self._canceled.add(action)

    def stop_answered(self, success: bool, text: str) -> None:
        """Take in what the stop service said."""
        self._stopped_by_service |= success
        self._service_said = text

    def seen(self, speed: float | None) -> None:
        """Take in a speed of the robot, m/s; None where its positions tell none."""
        self._stood = self._stood + 1 if speed is not None and abs(speed) <= STANDING else 0

    def step(self, abilities: Abilities, goals: Mapping[Action, Statuses], now: float) -> list[Effect]:
        """Return what is to be done now; ``goals`` are those of each action server."""
        missing = self._missing(abilities, goals)
        if not missing:
            return self._end()
        effects: list[Effect] = []
        if now >= self._twist_at and abilities.velocity and not self.is_refused:
            self._twist_at = now + TWIST_EVERY
            effects.append(ZeroTwist())
        if now >= self._ask_at:
            self._ask_at = now + (ASK_SELDOM if self.is_refused else ASK_AGAIN)
            effects += [CancelGoals(action) for action in sorted(abilities.actions)]
            effects += [CallStop()] * (abilities.stop_service and not self._stopped_by_service)
            effects += [PublishHere()] * abilities.goal_topic
        if now - self._began >= LONGEST and not self.is_refused:
            effects += self._refuse(missing)
        return effects

    def _missing(self, abilities: Abilities, goals: Mapping[Action, Statuses]) -> list[str]:
        """Return what has not been answered yet, in words."""
        missing = []
        for action in sorted(abilities.actions):
            active = any(status in ACTIVE for status in goals.get(action, {}).values())
            if action not in self._canceled:
                missing.append(f"its server of {action.value} does not answer")
            elif active:
                missing.append(f"its server of {action.value} still has a goal")
        if abilities.stop_service and not self._stopped_by_service:
            said = f", it said {self._service_said[:120]!r}" if self._service_said else ""
            missing.append(f"its stop service did not confirm{said}")
        if not abilities.actions and not abilities.stop_service and self._stood < 2:
            told = "it was sent speed 0" if abilities.velocity else "nobody listens there to any stop"
            missing.append(f"{told}, and it is not seen to stand")
        return missing

    def _end(self) -> list[Effect]:
        self.is_over = True
        return [Remark("it answered the stop after all")] if self.is_refused else [StopEnded()]

    def _refuse(self, missing: list[str]) -> list[Effect]:
        self.is_refused = True
        what = "; ".join(missing)
        return [StopEnded(f"the stop was not confirmed within {LONGEST:g} s: {what}. Stop it on site")]
