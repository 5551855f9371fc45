"""Ledger of one vehicle: effects to send and report, awaited actions, initial position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ...core.messages.robots import Request, SetPosIni
from .messages import Action, ActionParameter, FreshNames, InstantActions, Order, State
from .presence import VehiclePresence
from .tasks import Remembered, VehicleTask, recalled

# --- Effects of a message or of time: publications, reports to the gateway, and stored state


@dataclass(frozen=True)
class Publish:
    """A message to the vehicle. Without a broker it is lost; while due it is repeated."""

    message: Order | InstantActions


@dataclass(frozen=True)
class VehicleReport:
    """A request of the vehicle to the gateway."""

    request: Request


@dataclass(frozen=True)
class Settled:
    """Outcome of command ``command_id``: accepted, or with a reason refused or given up later."""

    command_id: int
    reason: str | None = None


@dataclass(frozen=True)
class Halted:
    """The vehicle shows that it stands: the stop is done."""


@dataclass(frozen=True)
class Keep:
    """State to be stored before any later effect."""

    remembered: Remembered


Effect = Publish | VehicleReport | Settled | Halted | Keep


# --- The stored state of one vehicle, and the effects of events ---

MOST_REMEMBERED = 50
"""Remembered orders that must no longer be executed, and ended commands."""


class Ledger:
    """The task and the pending effects; stored state comes before its effects."""

    def __init__(self, kept: Remembered, now: float) -> None:
        self._revoked, self._ended = list(kept.revoked), list(kept.ended)
        self._paused = kept.paused
        self._task = None if kept.task is None else recalled(kept.task, now)
        self._effects: list[Effect] = []

    @property
    def task(self) -> VehicleTask | None:
        """The motion command under way."""
        return self._task

    @property
    def is_paused(self) -> bool:
        """Whether a startPause of ours must be lifted before the next order."""
        return self._paused

    def drain(self) -> list[Effect]:
        """Return the effects since the last call, in the order of their execution."""
        effects, self._effects = self._effects, []
        return effects

    def report(self, request: Request) -> None:
        """Send a request to the gateway."""
        self._effects.append(VehicleReport(request))

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
        """Report the outcome of a command: with a reason it is refused, or given up."""
        self._effects.append(Settled(command_id, reason))

    def halted(self) -> None:
        """Report that the vehicle shows that it stands."""
        self._effects.append(Halted())

    def begin(self, task: VehicleTask) -> None:
        """Accept a task."""
        self._task = task
        self.keep()

    def end_task(self) -> None:
        """Record that the task is done."""
        if self._task is not None:
            self._ended = [*self._ended, self._task.command_id][-MOST_REMEMBERED:]
        self._task = None
        self.keep()

    def has_ended(self, command_id: int) -> bool:
        """Return whether a command ended recently."""
        return command_id in self._ended

    def refuse_task(self, reason: str) -> None:
        """End the task as failed."""
        if (task := self._revoke_task()) is not None:
            self.settle(task.command_id, reason)

    def drop_task(self, reason: str) -> None:
        """End the task for its replacement; an accepted one is not reported."""
        if (task := self._revoke_task()) is not None and not task.acknowledged:
            self.settle(task.command_id, reason)

    def is_revoked(self, order_id: str) -> bool:
        """Return whether an order of ours must no longer be executed."""
        return order_id in self._revoked

    def set_paused(self, paused: bool) -> None:
        """Record that the vehicle was paused, or may drive again."""
        if paused != self._paused:
            self._paused = paused
            self.keep()

    def keep(self) -> None:
        """Have the state stored before later effects."""
        task = None if self._task is None else self._task.remembered()
        revoked, ended = list(self._revoked), list(self._ended)
        kept = Remembered(task=task, paused=self._paused, revoked=revoked, ended=ended)
        self._effects.append(Keep(kept))

    def _revoke_task(self) -> VehicleTask | None:
        task, self._task = self._task, None
        if task is not None and task.plan is not None:
            self._revoked = [*self._revoked, task.plan.order_id][-MOST_REMEMBERED:]
        if task is not None:
            self.keep()
        return task


# --- SetPosIni as the instant action initPosition: a vehicle's initial pose ---


@dataclass(frozen=True)
class _Init:
    """An initPosition that the vehicle has not finished yet."""

    command_id: int
    action_id: str
    begun_at: float


class PositionInit:
    """Sets the vehicle's position, and settles the command once the vehicle has done so."""

    def __init__(
        self, ledger: Ledger, presence: VehiclePresence, names: FreshNames, finish_within: float
    ) -> None:
        self._ledger = ledger
        self._presence = presence
        self._names = names
        self._finish_within = finish_within
        self._init: _Init | None = None

    @property
    def is_waiting(self) -> bool:
        """Whether the vehicle has not answered yet."""
        return self._init is not None

    def begin(self, message: SetPosIni, command_id: int, now: float) -> None:
        """Send the position to the vehicle, or refuse it with the reason."""
        if self._init is not None and self._init.command_id == command_id:
            return
        presence, state = self._presence, self._presence.state
        map_id = presence.default_map()
        if self._ledger.task is not None or (state is not None and state.has_active_order):
            self._ledger.settle(command_id, "the vehicle carries out an order; abort that first")
        elif not presence.is_there(now):
            self._ledger.settle(command_id, presence.obstacle(now))
        elif map_id is None:
            self._ledger.settle(command_id, "it is not known on which map of [vda5050.maps] the vehicle is")
        else:
            self._init = _Init(command_id, self._names.draw(), now)
            parameters = self._parameters(message, map_id)
            self._ledger.publish_action("initPosition", self._init.action_id, "HARD", parameters)

    def note_state(self, state: State) -> None:
        """Settle it if the vehicle shows its outcome."""
        init = self._init
        if init is None:
            return
        action = state.action(init.action_id)
        fault = next((one for one in state.errors if one.refers("actionId", init.action_id)), None)
        if fault is None and (action is None or not action.has_ended):
            return
        self._init = None
        done = fault is None and action is not None and action.action_status == "FINISHED"
        reason = fault.summary if fault is not None else "the vehicle failed initPosition"
        self._ledger.settle(init.command_id, None if done else reason)

    def advance(self, now: float) -> None:
        """Refuse it if the vehicle does not answer."""
        if self._init is not None and now - self._init.begun_at > self._finish_within:
            command_id, self._init = self._init.command_id, None
            self._ledger.settle(command_id, "the vehicle has not finished initPosition")

    def _parameters(self, message: SetPosIni, map_id: str) -> list[ActionParameter]:
        presence = self._presence
        theta = message.theta
        if theta is None:
            theta = 0.0 if presence.pose is None else presence.pose.theta
        x, y, theta = presence.frame_of(map_id).from_site(message.x, message.y, theta)
        node = "" if presence.state is None else presence.state.last_node_id
        values: dict[str, str | float] = {"x": x, "y": y, "theta": theta, "mapId": map_id, "lastNodeId": node}
        return [ActionParameter(key, value) for key, value in values.items()]
