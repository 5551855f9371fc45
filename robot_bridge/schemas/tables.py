"""Which class each message of the wires is, for those that no table of the messages names."""

from __future__ import annotations

from ..messages import (
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
from ..messages.accounts import (
    AddOperator,
    GetOperators,
    NewToken,
    OperatorReport,
    Operators,
    RevokeToken,
    RotateToken,
    SetRole,
)
from ..messages.desk import (
    AbortAll,
    GetCommands,
    GetPositions,
    Hello,
    Send,
    SendMap,
    SetPositions,
    Subscribe,
)
from ..messages.geofence import Geofence
from ..messages.nearness import Nearness
from ..messages.observations import GetImage, GetObservations, ReviewObservation
from ..messages.placements import CollectLayout, GetPlacements
from ..messages.queues import (
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
from ..messages.removal import RemoveRobots, RobotsRemoved
from ..messages.results import (
    Audit,
    Commands,
    Done,
    HelloResult,
    Image,
    Observations,
    Positions,
    Queues,
    Sessions,
)
from ..messages.roads import (
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
from ..messages.service import PlaybackReport, SetPlayback, Suspensions
from ..messages.sites import ChooseSite, GetSites, Sites
from ..messages.stopping import AbortTask, ClearEmergencyStop, EmergencyReport, EmergencyStop
from ..messages.supervision import EndSession, GetAudit, GetSessions, SessionReport

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
}
"""What operators are told without asking, by method."""

HEADS: dict[str, type] = {"positions": PositionColumns}
"""The params in the JSON heads of binary frames, by method (see :mod:`..messages.position_columns`)."""
