"""What an operator may ask of the fleet: each request with the least role that may ask it, and its answer.

``hello`` and ``subscribe`` concern the connection alone; :mod:`.desk_server` answers them itself.
"""

from __future__ import annotations

import base64
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Any

from .access import supervision
from .errors import ForbiddenError
from .fleet import Fleet
from .messages import (
    AbortAll,
    AbortTask,
    ClearEmergencyStop,
    CommandReport,
    DeskRequest,
    EmergencyStop,
    EndSession,
    GetAudit,
    GetCommands,
    GetImage,
    GetObservations,
    GetPositions,
    GetSessions,
    GetTrajectory,
    ReviewObservation,
    Role,
    Send,
    SetPositions,
    to_json,
)
from .snapshots import positions
from .trajectories.reading import get_trajectory

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
            f"{request.method}: {caller.operator} is {caller.role.value}, and this takes "
            f"{service.role.value}; ask one, or have the role changed by 'robot-bridge operators role'"
        )
    return await service.answer(fleet, request, caller)


def _commands(reports: Sequence[CommandReport]) -> Json:
    return {"commands": [to_json(report) for report in reports]}


async def _get_positions(fleet: Fleet, _request: GetPositions, _caller: Caller) -> Json:
    return positions(fleet.reports())


async def _set_positions(fleet: Fleet, request: SetPositions, caller: Caller) -> Json:
    return _commands(await fleet.orders.set_positions(request.positions, caller.operator))


async def _send(fleet: Fleet, request: Send, caller: Caller) -> Json:
    return to_json(await fleet.orders.send(request, caller.operator))


async def _abort_all(fleet: Fleet, request: AbortAll, caller: Caller) -> Json:
    return _commands(await fleet.orders.abort_all(caller.operator, request.command, request.reason))


async def _abort(fleet: Fleet, request: AbortTask, caller: Caller) -> Json:
    return to_json(await fleet.orders.abort(request, caller.operator))


async def _emergency_stop(fleet: Fleet, request: EmergencyStop, caller: Caller) -> Json:
    return to_json(await fleet.emergency.stop(request, caller.operator))


async def _clear_emergency_stop(fleet: Fleet, request: ClearEmergencyStop, caller: Caller) -> Json:
    return to_json(await fleet.emergency.clear(request, caller.operator))


async def _get_commands(fleet: Fleet, request: GetCommands, _caller: Caller) -> Json:
    return _commands(await fleet.commands(request.robot, request.limit))


async def _get_observations(fleet: Fleet, request: GetObservations, _caller: Caller) -> Json:
    found = await fleet.observations.newest(request)
    return {"observations": [to_json(report) for report in found]}


async def _get_image(fleet: Fleet, request: GetImage, _caller: Caller) -> Json:
    image, media_type = await fleet.observations.image(request.observation)
    return {"media_type": media_type, "image": base64.b64encode(image).decode("ascii")}


async def _review_observation(fleet: Fleet, request: ReviewObservation, caller: Caller) -> Json:
    return to_json(await fleet.observations.review(request, caller.operator))


async def _get_sessions(fleet: Fleet, request: GetSessions, _caller: Caller) -> Json:
    return await supervision.get_sessions(fleet.database, request)


async def _end_session(fleet: Fleet, request: EndSession, caller: Caller) -> Json:
    return await supervision.end_session(fleet.database, request, caller.operator)


async def _get_audit(fleet: Fleet, request: GetAudit, _caller: Caller) -> Json:
    return await supervision.get_audit(fleet.database, request)


async def _get_trajectory(fleet: Fleet, request: GetTrajectory, _caller: Caller) -> Json:
    return to_json(await get_trajectory(fleet.database, request))


SERVICES: dict[type[DeskRequest], Service] = {
    GetPositions: Service(Role.VIEWER, _get_positions),
    GetCommands: Service(Role.VIEWER, _get_commands),
    GetTrajectory: Service(Role.VIEWER, _get_trajectory),
    GetObservations: Service(Role.VIEWER, _get_observations),
    GetImage: Service(Role.VIEWER, _get_image),
    ReviewObservation: Service(Role.OPERATOR, _review_observation),
    Send: Service(Role.OPERATOR, _send),
    SetPositions: Service(Role.OPERATOR, _set_positions),
    AbortAll: Service(Role.OPERATOR, _abort_all),
    AbortTask: Service(Role.OPERATOR, _abort),
    EmergencyStop: Service(Role.OPERATOR, _emergency_stop),
    ClearEmergencyStop: Service(Role.SUPERVISOR, _clear_emergency_stop),
    GetSessions: Service(Role.SUPERVISOR, _get_sessions),
    EndSession: Service(Role.SUPERVISOR, _end_session),
    GetAudit: Service(Role.SUPERVISOR, _get_audit),
}
