"""JSON Schemas (draft 2020-12) of all messages, made from their classes."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection, Sequence
from typing import Any

import msgspec

from ..core.messages import (
    PAYLOADS,
    CollectingTasks,
    CommandReport,
    DeskRequest,
    GetSurfaces,
    GetTrajectory,
    Links,
    ObservationReport,
    PlacementReport,
    Placements,
    PositionColumns,
    QueueReport,
    SiteReport,
    Stopping,
    Surfaces,
    Trajectory,
)
from ..core.messages.administration import (
    AddOperator,
    ChooseSite,
    EndSession,
    GetAudit,
    GetOperators,
    GetSessions,
    GetSites,
    NewToken,
    OperatorReport,
    Operators,
    PlaybackReport,
    RemoveRobots,
    RevokeToken,
    RobotsRemoved,
    RotateToken,
    SessionReport,
    SetPlayback,
    SetRole,
    Sites,
    Suspensions,
)
from ..core.messages.operator_requests import (
    AbortAll,
    Audit,
    Commands,
    Done,
    GetCommands,
    GetPositions,
    Hello,
    HelloResult,
    Image,
    Observations,
    Plans,
    Positions,
    Queues,
    Send,
    SendMap,
    Sessions,
    SetPositions,
    Subscribe,
)
from ..core.messages.plans import (
    ClearPlan,
    ConfirmReplan,
    DiscardReplan,
    GetPlans,
    PausePlan,
    PlanReport,
    Replan,
    ResumePlan,
    SubmitPlan,
)
from ..core.messages.queues import (
    AddTasks,
    GetQueue,
    MakeCurrent,
    MoveTask,
    PauseQueue,
    PauseRobot,
    RemoveTask,
    ResumeQueue,
    SetQueue,
    TakeOver,
)
from ..core.messages.records import CollectLayout, GetImage, GetObservations, GetPlacements, ReviewObservation
from ..core.messages.roads import (
    CloseRoad,
    ClosureReport,
    Closures,
    ConflictResolved,
    Conflicts,
    GetClosures,
    GetConflicts,
    GetRoute,
    GetWaysOut,
    OpenRoad,
    ReplannedRobot,
    ResolveConflict,
    RoadClosed,
    RouteReport,
    WaysOut,
)
from ..core.messages.safety import (
    AbortTask,
    ClearEmergencyStop,
    EmergencyReport,
    EmergencyStop,
    Geofence,
    Nearness,
)

# --- The JSON Schema (draft 2020-12) of each message, from its class: types, defaults, ranges and texts

Schema = dict[str, Any]

JSON_SCHEMA = "$schema"
"""The key under which a document names the draft that it follows."""


def definitions(classes: Sequence[type], template: str, closed: Sequence[type] = ()) -> dict[str, Schema]:
    """Return the schemas of ``classes`` and of what they hold, by class name.

    ``template`` is how they refer to each other, such as ``#/$defs/{name}``. Those in ``closed``, and what
    they hold, take no properties that they do not name; but for what stops robots, which is never refused.
    """
    _, found = msgspec.json.schema_components(classes, ref_template=template)
    holders = {cls.__name__: cls for cls in classes}
    shut = _names_in(closed) - {cls.__name__ for cls in classes if getattr(cls, "stops", False)}
    return {name: _refined(schema, holders.get(name), shut) for name, schema in found.items()}


def schema_of(cls: type, *, closed: bool = False) -> Schema:
    """Return the schema of one message by itself; a ``closed`` one takes no other properties."""
    found = definitions([cls], "#/$defs/{name}", [cls] if closed else [])
    schema = found.pop(cls.__name__)
    inner = {"$defs": found} if found else {}
    return {JSON_SCHEMA: "https://json-schema.org/draft/2020-12/schema", **schema, **inner}


def plain_text(text: str) -> str:
    """Return a docstring as text for people who do not read Python."""
    text = re.sub(r":\w+:`[~.]*([^`]*)`", r"`\1`", inspect.cleandoc(text)).replace("``", "`")
    return re.sub(r"(?<!\n)\n(?!\n)", " ", text)


def _names_in(classes: Sequence[type]) -> set[str]:
    """Return the names of ``classes`` and of all that they hold."""
    return set(msgspec.json.schema_components(classes)[1]) if classes else set()


def _refined(schema: Schema, cls: type | None, closed: Collection[str]) -> Schema:
    refined = dict(schema)
    if refined.get("type") == "object" and refined.get("title") in closed:
        refined["additionalProperties"] = False
    if "description" in refined:
        refined["description"] = plain_text(refined["description"])
    properties = {name: dict(value) for name, value in schema.get("properties", {}).items()}
    for name, (least, most) in getattr(cls, "ranges", {}).items():
        _limit(properties[name], {"minimum": least, "maximum": most})
    for name, longest in getattr(cls, "texts", {}).items():
        _limit(properties[name], {"minLength": 1, "maxLength": longest})
    payload = PAYLOADS.get(refined.get("title", ""))
    if payload is not None:
        properties[payload]["description"] = "In base64; on SQL it is the row's payload, and not here."
        refined["required"] = [name for name in refined.get("required", []) if name != payload]
    return {**refined, "properties": properties} if properties else refined


def _limit(value: Schema, limits: Schema) -> None:
    """Write ``limits`` where a property says its type; null stays what it is."""
    if "anyOf" not in value:
        value.update(limits)
        return
    value["anyOf"] = [each if each.get("type") == "null" else {**each, **limits} for each in value["anyOf"]]


# --- Which class each message of the wires is, for those that no table of the messages names ---

RESULTS: dict[type[DeskRequest], type] = {
    Hello: HelloResult,
    Subscribe: Done,
    GetPositions: Positions,
    SetPositions: Commands,
    Send: CommandReport,
    SendMap: Done,
    AbortAll: Commands,
    AbortTask: CommandReport,
    EmergencyStop: EmergencyReport,
    ClearEmergencyStop: EmergencyReport,
    GetCommands: Commands,
    GetObservations: Observations,
    GetImage: Image,
    ReviewObservation: ObservationReport,
    GetSites: Sites,
    ChooseSite: SiteReport,
    GetSessions: Sessions,
    EndSession: SessionReport,
    GetAudit: Audit,
    GetOperators: Operators,
    AddOperator: NewToken,
    RotateToken: NewToken,
    RevokeToken: OperatorReport,
    SetRole: OperatorReport,
    GetTrajectory: Trajectory,
    GetSurfaces: Surfaces,
    SetQueue: QueueReport,
    AddTasks: QueueReport,
    MoveTask: QueueReport,
    RemoveTask: QueueReport,
    MakeCurrent: QueueReport,
    PauseQueue: QueueReport,
    PauseRobot: QueueReport,
    ResumeQueue: QueueReport,
    GetQueue: Queues,
    TakeOver: Queues,
    SubmitPlan: PlanReport,
    GetPlans: Plans,
    PausePlan: PlanReport,
    ResumePlan: PlanReport,
    Replan: PlanReport,
    ConfirmReplan: PlanReport,
    DiscardReplan: PlanReport,
    ClearPlan: PlanReport,
    GetPlacements: Placements,
    CollectLayout: CollectingTasks,
    GetRoute: RouteReport,
    CloseRoad: RoadClosed,
    OpenRoad: ClosureReport,
    GetClosures: Closures,
    GetConflicts: Conflicts,
    GetWaysOut: WaysOut,
    ResolveConflict: ConflictResolved,
    RemoveRobots: RobotsRemoved,
    SetPlayback: PlaybackReport,
}
"""What each request of an operator is answered with."""

NOTIFICATIONS: dict[str, type] = {
    "positions": Positions,
    "command": CommandReport,
    "observation": ObservationReport,
    "emergency": EmergencyReport,
    "site": SiteReport,
    "stopping": Stopping,
    "suspensions": Suspensions,
    "links": Links,
    "closures": Closures,
    "replanned": ReplannedRobot,
    "conflicts": Conflicts,
    "geofence": Geofence,
    "nearness": Nearness,
    "queue": QueueReport,
    "placement": PlacementReport,
    "plan": PlanReport,
}
"""What operators are told without asking, by method."""

HEADS: dict[str, type] = {"positions": PositionColumns}
"""The params in the JSON heads of binary frames, by method (see :mod:`..core.messages.operator_requests`)."""
