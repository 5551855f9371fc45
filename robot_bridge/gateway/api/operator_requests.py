"""Requests of operators: each with the least role that may make it, and its answer."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ...core.errors import ForbiddenError, RefusedError
from ...core.messages import (
    AbortAll,
    AbortTask,
    AddOperator,
    AddTasks,
    ChooseSite,
    ClearEmergencyStop,
    ClearPlan,
    CloseRoad,
    CollectLayout,
    CommandReport,
    ConfirmReplan,
    DeskRequest,
    DiscardReplan,
    EmergencyStop,
    EndSession,
    GetAudit,
    GetClosures,
    GetCommands,
    GetConflicts,
    GetImage,
    GetObservations,
    GetOperators,
    GetPlacements,
    GetPlans,
    GetPositions,
    GetQueue,
    GetRoute,
    GetSessions,
    GetSites,
    GetSurfaces,
    GetTrajectory,
    GetWaysOut,
    MakeCurrent,
    MoveTask,
    OpenRoad,
    PausePlan,
    PauseQueue,
    PauseRobot,
    QueueReport,
    RemoveRobots,
    RemoveTask,
    Replan,
    ResolveConflict,
    ResumePlan,
    ResumeQueue,
    ReviewObservation,
    RevokeToken,
    RobotState,
    Role,
    RotateToken,
    Send,
    SendMap,
    SetPlayback,
    SetPositions,
    SetQueue,
    SetRole,
    Sites,
    SubmitPlan,
    SurfaceAt,
    TakeOver,
    to_json,
)
from ..auth import administration
from ..fleet.operator_updates import positions
from ..fleet.service import Fleet
from ..site.places import SiteChoice, route_in_site_frame
from ..storage.repositories import records
from ..traffic import road_planning
from ..trajectories.recording import get_trajectory

# --- The map of the whole site, sent to a robot because an operator asks for it ---


async def send_map(fleet: Fleet, request: SendMap) -> None:
    """Return when the map for the robot is stored; it replaces one that still waits for it.

    :raises RefusedError: for a robot that is not known, or is not there.
    """
    fleet.robots.check_known(request.robot)
    if fleet.robots.get(request.robot).state is RobotState.OFFLINE:
        raise RefusedError(
            f"robot {request.robot!r} is offline; it is sent the map by itself when it connects"
        )
    if not fleet.robots.get(request.robot).can("map"):
        raise RefusedError(f"robot {request.robot!r} takes no maps, as it said when it connected")
    await fleet.maps.send(request.robot)


# --- What an operator may ask of the fleet: each request with the least role that may ask it, and its answer
# ``hello`` and ``subscribe`` concern the connection alone; :mod:`.desk_server` answers them itself.

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
    return positions(fleet.rows(), everything=True)


async def _set_positions(fleet: Fleet, request: SetPositions, caller: Caller) -> Json:
    return _commands(await fleet.orders.set_positions(request.positions, caller.operator))


def _check_override(
    fleet: Fleet,
    request: Send | SetQueue | AddTasks | TakeOver | SubmitPlan | ConfirmReplan,
    caller: Caller,
) -> None:
    """Raise ForbiddenError for an override that the caller's role does not reach."""
    least = Role(fleet.site.settings.commands.override_role)
    if request.override is not None and not caller.role.includes(least):
        raise ForbiddenError(
            f"{request.method}: {caller.operator} is {caller.role.value}, and an override takes "
            f"{least.value}; choose another place or way, or ask one (override_role in the site's settings)"
        )


async def _send(fleet: Fleet, request: Send, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return to_json(await fleet.orders.send(request, caller.operator))


async def _send_map(fleet: Fleet, request: SendMap, _caller: Caller) -> Json:
    await send_map(fleet, request)
    return {}


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
    return await administration.get_sessions(fleet.database, request)


async def _end_session(fleet: Fleet, request: EndSession, caller: Caller) -> Json:
    return await administration.end_session(fleet.database, request, caller.operator)


async def _get_audit(fleet: Fleet, request: GetAudit, _caller: Caller) -> Json:
    return await administration.get_audit(fleet.database, request)


async def _get_operators(fleet: Fleet, _request: GetOperators, _caller: Caller) -> Json:
    return await administration.get_operators(fleet.database)


async def _add_operator(fleet: Fleet, request: AddOperator, _caller: Caller) -> Json:
    return await administration.add_operator(fleet.database, request)


async def _rotate_token(fleet: Fleet, request: RotateToken, _caller: Caller) -> Json:
    return await administration.rotate_token(fleet.database, request)


async def _revoke_token(fleet: Fleet, request: RevokeToken, _caller: Caller) -> Json:
    return await administration.revoke_token(fleet.database, request)


async def _set_role(fleet: Fleet, request: SetRole, _caller: Caller) -> Json:
    return await administration.set_role(fleet.database, request)


async def _get_sites(fleet: Fleet, _request: GetSites, _caller: Caller) -> Json:
    return to_json(Sites(await _site_choice(fleet).offers()))


async def _choose_site(fleet: Fleet, request: ChooseSite, _caller: Caller) -> Json:
    return to_json(await _site_choice(fleet).choose(request.site))


def _site_choice(fleet: Fleet) -> SiteChoice:
    if fleet.site_choice is None:
        raise RefusedError("this gateway serves one site, and there is no choice")
    return fleet.site_choice


async def _get_trajectory(fleet: Fleet, request: GetTrajectory, _caller: Caller) -> Json:
    return to_json(await get_trajectory(fleet.database, request))


async def _set_queue(fleet: Fleet, request: SetQueue, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return to_json(await fleet.queues.set(request, caller.operator))


async def _add_tasks(fleet: Fleet, request: AddTasks, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return to_json(await fleet.queues.add(request, caller.operator))


async def _move_task(fleet: Fleet, request: MoveTask, caller: Caller) -> Json:
    return to_json(await fleet.queues.move(request, caller.operator))


async def _remove_task(fleet: Fleet, request: RemoveTask, caller: Caller) -> Json:
    return to_json(await fleet.queues.remove(request, caller.operator))


async def _make_current(fleet: Fleet, request: MakeCurrent, caller: Caller) -> Json:
    return to_json(await fleet.queues.make_current(request, caller.operator))


async def _pause_queue(fleet: Fleet, request: PauseQueue, caller: Caller) -> Json:
    return to_json(await fleet.queues.pause(request, caller.operator))


async def _pause_robot(fleet: Fleet, request: PauseRobot, caller: Caller) -> Json:
    return to_json(await fleet.pauses.pause(request, caller.operator))


async def _resume_queue(fleet: Fleet, request: ResumeQueue, caller: Caller) -> Json:
    return to_json(await fleet.queues.resume(request, caller.operator))


async def _take_over(fleet: Fleet, request: TakeOver, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return _queues(await fleet.queues.take_over(request, caller.operator))


async def _get_queue(fleet: Fleet, request: GetQueue, _caller: Caller) -> Json:
    return _queues(await fleet.queues.read(request))


def _queues(reports: Sequence[QueueReport]) -> Json:
    return {"queues": [to_json(report) for report in reports]}


async def _submit_plan(fleet: Fleet, request: SubmitPlan, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return to_json(await fleet.plans.submit(request, caller.operator))


async def _pause_plan(fleet: Fleet, request: PausePlan, caller: Caller) -> Json:
    return to_json(await fleet.plans.pause(request, caller.operator))


async def _resume_plan(fleet: Fleet, request: ResumePlan, caller: Caller) -> Json:
    return to_json(await fleet.plans.resume(request, caller.operator))


async def _replan(fleet: Fleet, request: Replan, caller: Caller) -> Json:
    return to_json(await fleet.plans.replan(request, caller.operator))


async def _confirm_replan(fleet: Fleet, request: ConfirmReplan, caller: Caller) -> Json:
    _check_override(fleet, request, caller)
    return to_json(await fleet.plans.confirm(request, caller.operator))


async def _discard_replan(fleet: Fleet, request: DiscardReplan, caller: Caller) -> Json:
    return to_json(await fleet.plans.discard(request, caller.operator))


async def _clear_plan(fleet: Fleet, request: ClearPlan, caller: Caller) -> Json:
    return to_json(await fleet.plans.clear(request, caller.operator))


async def _get_plans(fleet: Fleet, request: GetPlans, _caller: Caller) -> Json:
    return {"plans": [to_json(report) for report in await fleet.plans.read(request)]}


async def _get_placements(fleet: Fleet, request: GetPlacements, _caller: Caller) -> Json:
    found = await fleet.database.read(records.newest_placed_cones, request)
    return {"placements": [to_json(report) for report in found]}


async def _collect_layout(fleet: Fleet, request: CollectLayout, _caller: Caller) -> Json:
    return to_json(await fleet.queues.collecting(request))


async def _get_surface(fleet: Fleet, request: GetSurfaces, _caller: Caller) -> Json:
    return await asyncio.to_thread(_surfaces, fleet, request)


def _surfaces(fleet: Fleet, request: GetSurfaces) -> Json:
    try:
        found = fleet.site.surfaces_at(request.points, request.crs)
    except RefusedError as error:
        raise RefusedError(f"get_surface: {error}") from error
    told = [one and to_json(SurfaceAt(one.label, one.origin, one.name or None)) for one in found]
    return {"surfaces": told}


async def _get_route(fleet: Fleet, request: GetRoute, _caller: Caller) -> Json:
    request = await route_in_site_frame(fleet.site, request)
    return to_json(
        await road_planning.route_for_operator(fleet.roads.planner, fleet.robots, fleet.roads.ways, request)
    )


async def _close_road(fleet: Fleet, request: CloseRoad, caller: Caller) -> Json:
    return to_json(await fleet.roads.closures.close(request, caller.operator))


async def _open_road(fleet: Fleet, request: OpenRoad, caller: Caller) -> Json:
    return to_json(await fleet.roads.closures.open(request, caller.operator))


async def _get_closures(fleet: Fleet, _request: GetClosures, _caller: Caller) -> Json:
    return to_json(fleet.roads.closures.report())


async def _get_conflicts(fleet: Fleet, _request: GetConflicts, _caller: Caller) -> Json:
    return to_json(await fleet.roads.traffic.conflicts())


async def _get_ways_out(fleet: Fleet, request: GetWaysOut, _caller: Caller) -> Json:
    return to_json(await fleet.roads.traffic.ways_out(request))


async def _resolve_conflict(fleet: Fleet, request: ResolveConflict, caller: Caller) -> Json:
    return to_json(await fleet.roads.traffic.resolve(request, caller.operator))


async def _remove_robots(fleet: Fleet, request: RemoveRobots, caller: Caller) -> Json:
    return to_json(await fleet.removals.remove(request, caller.operator))


async def _set_playback(fleet: Fleet, request: SetPlayback, _caller: Caller) -> Json:
    return to_json(await fleet.links.set_playback(request))


SERVICES: dict[type[DeskRequest], Service] = {
    GetPositions: Service(Role.VIEWER, _get_positions),
    GetCommands: Service(Role.VIEWER, _get_commands),
    GetSurfaces: Service(Role.VIEWER, _get_surface),
    GetTrajectory: Service(Role.VIEWER, _get_trajectory),
    GetObservations: Service(Role.VIEWER, _get_observations),
    GetImage: Service(Role.VIEWER, _get_image),
    ReviewObservation: Service(Role.OPERATOR, _review_observation),
    GetQueue: Service(Role.VIEWER, _get_queue),
    GetPlacements: Service(Role.VIEWER, _get_placements),
    CollectLayout: Service(Role.VIEWER, _collect_layout),
    SetQueue: Service(Role.OPERATOR, _set_queue),
    AddTasks: Service(Role.OPERATOR, _add_tasks),
    MoveTask: Service(Role.OPERATOR, _move_task),
    RemoveTask: Service(Role.OPERATOR, _remove_task),
    MakeCurrent: Service(Role.OPERATOR, _make_current),
    PauseQueue: Service(Role.OPERATOR, _pause_queue),
    PauseRobot: Service(Role.OPERATOR, _pause_robot),
    ResumeQueue: Service(Role.OPERATOR, _resume_queue),
    TakeOver: Service(Role.OPERATOR, _take_over),
    GetPlans: Service(Role.VIEWER, _get_plans),
    SubmitPlan: Service(Role.OPERATOR, _submit_plan),
    PausePlan: Service(Role.OPERATOR, _pause_plan),
    ResumePlan: Service(Role.OPERATOR, _resume_plan),
    Replan: Service(Role.OPERATOR, _replan),
    ConfirmReplan: Service(Role.OPERATOR, _confirm_replan),
    DiscardReplan: Service(Role.OPERATOR, _discard_replan),
    ClearPlan: Service(Role.OPERATOR, _clear_plan),
    Send: Service(Role.OPERATOR, _send),
    SendMap: Service(Role.OPERATOR, _send_map),
    SetPositions: Service(Role.OPERATOR, _set_positions),
    AbortAll: Service(Role.OPERATOR, _abort_all),
    AbortTask: Service(Role.OPERATOR, _abort),
    EmergencyStop: Service(Role.OPERATOR, _emergency_stop),
    ClearEmergencyStop: Service(Role.SUPERVISOR, _clear_emergency_stop),
    GetSessions: Service(Role.SUPERVISOR, _get_sessions),
    EndSession: Service(Role.SUPERVISOR, _end_session),
    GetAudit: Service(Role.SUPERVISOR, _get_audit),
    GetOperators: Service(Role.SUPERVISOR, _get_operators),
    AddOperator: Service(Role.SUPERVISOR, _add_operator),
    RotateToken: Service(Role.SUPERVISOR, _rotate_token),
    RevokeToken: Service(Role.SUPERVISOR, _revoke_token),
    SetRole: Service(Role.SUPERVISOR, _set_role),
    GetSites: Service(Role.SUPERVISOR, _get_sites),
    ChooseSite: Service(Role.SUPERVISOR, _choose_site),
    GetRoute: Service(Role.VIEWER, _get_route),
    GetClosures: Service(Role.VIEWER, _get_closures),
    GetConflicts: Service(Role.VIEWER, _get_conflicts),
    GetWaysOut: Service(Role.VIEWER, _get_ways_out),
    CloseRoad: Service(Role.OPERATOR, _close_road),
    OpenRoad: Service(Role.OPERATOR, _open_road),
    ResolveConflict: Service(Role.OPERATOR, _resolve_conflict),
    RemoveRobots: Service(Role.SUPERVISOR, _remove_robots),
    SetPlayback: Service(Role.OPERATOR, _set_playback),
}
