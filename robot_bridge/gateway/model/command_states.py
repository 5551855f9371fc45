"""The life of a command, as a pure state machine (design: queued → delivered → acknowledged → reached)."""

from __future__ import annotations

import dataclasses

from ...core.messages.commands import CommandReport, CommandState, CommandStep

_ENDS = {
    CommandState.REACHED,
    CommandState.ABORTED,
    CommandState.FAILED,
    CommandState.EXPIRED,
    CommandState.SUPERSEDED,
}
_FORWARD = [CommandState.QUEUED, CommandState.DELIVERED, CommandState.ACKNOWLEDGED, CommandState.REACHED]


class CommandLifeError(Exception):
    """A step that the life of a command does not have."""


def is_open(state: CommandState) -> bool:
    """Tell whether a command in ``state`` still has a step to come."""
    return state not in _ENDS


def may_become(now: CommandState, then: CommandState) -> bool:
    """Tell whether a command may step from ``now`` to ``then``.

    Steps may be skipped forward (an acknowledgement proves the delivery) and never go back.
    """
    if not is_open(now):
        return False
    if then in _FORWARD:
        return _FORWARD.index(then) > _FORWARD.index(now)
    return True


def advance(
    command: CommandReport,
    state: CommandState,
    at: float,
    by: str,
    reason: str | None = None,
    deviation: float | None = None,
    stood: tuple[float, float, float] | None = None,
) -> CommandReport:
    """Return ``command`` one step further; raises CommandLifeError for a step it may not take."""
    if not may_become(command.state, state):
        raise CommandLifeError(
            f"command {command.command} is {command.state.value} and cannot become {state.value}"
        )
    return dataclasses.replace(
        command,
        state=state,
        steps=[*command.steps, CommandStep(state, at, by, reason)],
        deviation=command.deviation if deviation is None else deviation,
        stood=command.stood if stood is None else stood,
    )


def note(command: CommandReport, at: float, by: str, reason: str) -> CommandReport:
    """Return ``command`` in the same state with one more line in its history."""
    return dataclasses.replace(command, steps=[*command.steps, CommandStep(command.state, at, by, reason)])
