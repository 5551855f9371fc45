"""What an operator may ask of the fleet: each request with the least role that may ask it, and its answer.

``hello`` and ``subscribe`` concern the connection alone; :mod:`.desk_server` answers them itself.
"""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Any

from .errors import ForbiddenError
from .fleet import Fleet
from .messages import (
    AbortAll,
    CommandReport,
    DeskRequest,
    GetCommands,
    GetPositions,
    RobotReport,
    Role,
    Send,
    SetPositions,
    to_json,
)

Json = dict[str, Any]


@dataclass(frozen=True)
class Caller:
    """Who asks: the operator's account, its role, and where the connection comes from."""

    operator: str
    role: Role
    address: str


@dataclass(frozen=True)
class Service:
    """One request's least role and its answer."""

    role: Role
    answer: Callable[[Fleet, Any, Caller], Awaitable[Json]]


async def answer(fleet: Fleet, request: DeskRequest, caller: Caller) -> Json:
    """Return the result of ``request`` as JSON values.

    :raises ForbiddenError: when the caller's role does not reach; else what the fleet raises.
    """
    service = SERVICES[type(request)]
    if not caller.role.includes(service.role):
        raise ForbiddenError(
            f"{request.method}: {caller.operator} is {caller.role.value}, and this takes a "
            f"{service.role.value}; ask one, or have the role changed by 'robot-bridge operators role'"
        )
    return await service.answer(fleet, request, caller)


def positions(robots: Sequence[RobotReport]) -> Json:
    """Return reports as the parameters of ``positions`` and the result of ``get_positions``."""
    return {"t": round(time.time(), 3), "robots": [to_json(robot) for robot in robots]}


def _commands(reports: Sequence[CommandReport]) -> Json:
    return {"commands": [to_json(report) for report in reports]}


async def _get_positions(fleet: Fleet, _request: GetPositions, _caller: Caller) -> Json:
    return positions(fleet.reports())


async def _set_positions(fleet: Fleet, request: SetPositions, caller: Caller) -> Json:
    return _commands(await fleet.set_positions(request.positions, caller.operator))


async def _send(fleet: Fleet, request: Send, caller: Caller) -> Json:
    return to_json(await fleet.send(request, caller.operator))


async def _abort_all(fleet: Fleet, request: AbortAll, caller: Caller) -> Json:
    return _commands(await fleet.abort_all(caller.operator, request.command))


async def _get_commands(fleet: Fleet, request: GetCommands, _caller: Caller) -> Json:
    return _commands(await fleet.commands(request.robot, request.limit))


SERVICES: dict[type[DeskRequest], Service] = {
    GetPositions: Service(Role.VIEWER, _get_positions),
    GetCommands: Service(Role.VIEWER, _get_commands),
    Send: Service(Role.OPERATOR, _send),
    SetPositions: Service(Role.OPERATOR, _set_positions),
    AbortAll: Service(Role.OPERATOR, _abort_all),
}
