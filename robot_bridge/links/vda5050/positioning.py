"""SetPosIni as the instant action initPosition: where a vehicle is to take itself to be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...messages import SetPosIni
from .inbound import State
from .ledger import Ledger
from .outbound import ActionParameter
from .presence import Presence


@dataclass(frozen=True)
class _Init:
    """An initPosition that the vehicle has not finished yet."""

    command_id: int
    action_id: str
    begun_at: float


class PositionInit:
    """Has the vehicle take a position, and settles that once the vehicle has done so."""

    def __init__(
        self, ledger: Ledger, presence: Presence, new_id: Callable[[], str], finish_within: float
    ) -> None:
        self._ledger = ledger
        self._presence = presence
        self._new_id = new_id
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
            self._init = _Init(command_id, self._new_id(), now)
            parameters = self._parameters(message, map_id)
            self._ledger.publish_action("initPosition", self._init.action_id, "HARD", parameters)

    def note_state(self, state: State) -> None:
        """Settle it where the vehicle shows what became of it."""
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
        """Refuse it where the vehicle does not answer."""
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
