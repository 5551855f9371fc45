"""What one vehicle is occupied with, kept, and the effects of all that happens to it."""

from __future__ import annotations

from typing import Literal

from ...messages import Request
from .effects import Effect, Halted, Keep, Publish, Report, Settled
from .memory import Remembered
from .outbound import Action, ActionParameter, InstantActions, Order
from .tasks import Task, recalled

MOST_REMEMBERED = 50
"""Orders that are remembered as not to be carried out any more, and commands that are over."""


class Ledger:
    """The task and what is to be carried out; what is kept comes before what follows of it."""

    def __init__(self, kept: Remembered, now: float) -> None:
        self._revoked, self._ended = list(kept.revoked), list(kept.ended)
        self._paused = kept.paused
        self._task = None if kept.task is None else recalled(kept.task, now)
        self._effects: list[Effect] = []

    @property
    def task(self) -> Task | None:
        """The motion command under way."""
        return self._task

    @property
    def is_paused(self) -> bool:
        """Whether a startPause of ours is to be lifted before the next order."""
        return self._paused

    def drain(self) -> list[Effect]:
        """Return the effects since the last call, in the order in which they are to be carried out."""
        effects, self._effects = self._effects, []
        return effects

    def report(self, request: Request) -> None:
        """Say something to the gateway."""
        self._effects.append(Report(request))

    def publish(self, message: Order | InstantActions) -> None:
        """Publish a message to the vehicle."""
        self._effects.append(Publish(message))

    def publish_action(
        self,
        action_type: str,
        action_id: str,
        blocking_type: Literal["NONE", "HARD"] = "NONE",
        parameters: list[ActionParameter] | None = None,
    ) -> None:
        """Publish one instant action."""
        action = Action(
            action_type=action_type,
            action_id=action_id,
            blocking_type=blocking_type,
            action_parameters=parameters or [],
        )
        self.publish(InstantActions(actions=[action]))

    def settle(self, command_id: int, reason: str | None = None) -> None:
        """Say what came of a command: with a reason it is refused, or given up."""
        self._effects.append(Settled(command_id, reason))

    def halted(self) -> None:
        """Say that the vehicle shows that it stands."""
        self._effects.append(Halted())

    def begin(self, task: Task) -> None:
        """Take a task on."""
        self._task = task
        self.keep()

    def end_task(self) -> None:
        """Note that the task is done."""
        if self._task is not None:
            self._ended = [*self._ended, self._task.command_id][-MOST_REMEMBERED:]
        self._task = None
        self.keep()

    def has_ended(self, command_id: int) -> bool:
        """Tell whether a command was done, lately."""
        return command_id in self._ended

    def refuse_task(self, reason: str) -> None:
        """End the task as failed."""
        if (task := self._revoke_task()) is not None:
            self.settle(task.command_id, reason)

    def drop_task(self, reason: str) -> None:
        """End the task for something that came in its place; one that was taken on needs no word."""
        if (task := self._revoke_task()) is not None and not task.acknowledged:
            self.settle(task.command_id, reason)

    def is_revoked(self, order_id: str) -> bool:
        """Tell whether an order of ours is not to be carried out any more."""
        return order_id in self._revoked

    def set_paused(self, paused: bool) -> None:
        """Note that the vehicle was paused, or that it may drive again."""
        if paused != self._paused:
            self._paused = paused
            self.keep()

    def keep(self) -> None:
        """Have all this kept before what follows."""
        task = None if self._task is None else self._task.remembered()
        revoked, ended = list(self._revoked), list(self._ended)
        kept = Remembered(task=task, paused=self._paused, revoked=revoked, ended=ended)
        self._effects.append(Keep(kept))

    def _revoke_task(self) -> Task | None:
        task, self._task = self._task, None
        if task is not None and task.plan is not None:
            self._revoked = [*self._revoked, task.plan.order_id][-MOST_REMEMBERED:]
        if task is not None:
            self.keep()
        return task
