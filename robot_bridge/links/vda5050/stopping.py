"""The stop of a vehicle: cancelOrder, startPause if that is not enough, until the vehicle shows it."""

from __future__ import annotations

from dataclasses import dataclass

from .messages import Action, FreshNames, InstantActions, State


@dataclass(frozen=True)
class StopLimits:
    """Seconds: until startPause, between repetitions, and until operators learn that it does not stop."""

    pause_after: float = 2.0
    repeat_after: float = 2.0
    unanswered_after: float = 5.0


class StopProcedure:
    """One stop of a vehicle, from the Abort (or from the order that replaces another) until it stands.

    Only states received after its beginning count. ``names`` are for actions; a vehicle that cannot pause is
    sent no startPause.
    """

    def __init__(
        self, begun_at: float, limits: StopLimits, names: FreshNames, *, can_pause: bool = True
    ) -> None:
        self._begun_at = begun_at
        self._limits = limits
        self._names = names
        self._can_pause = can_pause
        self._emergency = False
        self._state: State | None = None
        self._received_at = begun_at
        self._cancels: list[str] = []
        self._cancelled_at: float | None = None
        self._paused_at: float | None = None
        self._evident = False

    @property
    def has_paused(self) -> bool:
        """Whether startPause was sent."""
        return self._paused_at is not None

    def set_emergency(self) -> None:
        """Pause the vehicle at once, too."""
        self._emergency = True

    def due(self, now: float) -> list[InstantActions]:
        """Return the messages due now. Each action is a separate message: none waits behind another."""
        actions = []
        if self._is_cancel_due(now):
            repeated = self._cancelled_at is not None
            self._cancelled_at = now
            self._cancels.append(self._names.draw())
            actions.append(Action(action_type="cancelOrder", action_id=self._cancels[-1]))
            if repeated:
                actions.append(Action(action_type="stateRequest", action_id=self._names.draw()))
        if self._is_pause_due(now):
            self._paused_at = now
            actions.append(Action(action_type="startPause", action_id=self._names.draw()))
        return [InstantActions(actions=[action]) for action in actions]

    def note_state(self, state: State, now: float) -> None:
        """Record a state received since the stop began."""
        self._state, self._received_at = state, now
        for action_id in self._cancels:
            if state.action(action_id) is not None:
                self._evident = True
            if any(error.refers("actionId", action_id) for error in state.errors):
                self._evident = True

    @property
    def has_ended(self) -> bool:
        """Whether the vehicle stands and has no order left.

        A state from before the arrival of cancelOrder does not show that: an order may have been on its way.
        """
        if self._state is None or self._state.driving or self._state.has_active_order:
            return False
        return self._evident or self._received_at - self._begun_at >= self._limits.repeat_after

    @property
    def stands(self) -> bool:
        """Whether the vehicle drives no further: its order has ended, or it is paused."""
        state = self._state
        return self.has_ended or (state is not None and state.paused and not state.driving)

    def complaint(self, now: float) -> str | None:
        """Return a complaint on a vehicle that does not show in time that it has stopped, or None."""
        if now - self._begun_at < self._limits.unanswered_after or self.has_ended:
            return None
        if self.stands:
            return "stands paused, but has not finished cancelOrder"
        if not self._evident:
            return "DOES NOT ANSWER cancelOrder: stop it at the vehicle"
        return "DRIVES ON despite cancelOrder: stop it at the vehicle"

    def _is_cancel_due(self, now: float) -> bool:
        if self._cancelled_at is None:
            return True
        if self.has_ended or now - self._cancelled_at < self._limits.repeat_after:
            return False
        newest = None if self._state is None else self._state.action(self._cancels[-1])
        return newest is None or newest.has_ended

    def _is_pause_due(self, now: float) -> bool:
        if not self._can_pause or (self._state is not None and self._state.paused):
            return False
        if self._emergency and self._paused_at is None:
            return True
        if self.has_ended or now - self._begun_at < self._limits.pause_after:
            return False
        return self._paused_at is None or now - self._paused_at >= self._limits.repeat_after
