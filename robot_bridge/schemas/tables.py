"""Which class each message of the wires is, for those that no table of the messages names."""

from __future__ import annotations

from ..messages import (
    CommandReport,
    DeskRequest,
    GetTrajectory,
    ObservationReport,
    SiteReport,
    Stopping,
    Trajectory,
)
from ..messages.desk import (
    AbortAll,
    GetCommands,
    GetPositions,
    Hello,
    Send,
    SetPositions,
    Subscribe,
)
from ..messages.observations import GetImage, GetObservations, ReviewObservation
from ..messages.results import Audit, Commands, Done, HelloResult, Image, Observations, Positions, Sessions
from ..messages.stopping import AbortTask, ClearEmergencyStop, EmergencyReport, EmergencyStop
from ..messages.supervision import EndSession, GetAudit, GetSessions, SessionReport

RESULTS: dict[type[DeskRequest], type] = {
    Hello: HelloResult,
    Subscribe: Done,
    GetPositions: Positions,
    SetPositions: Commands,
    Send: CommandReport,
    AbortAll: Commands,
    AbortTask: CommandReport,
    EmergencyStop: EmergencyReport,
    ClearEmergencyStop: EmergencyReport,
    GetCommands: Commands,
    GetObservations: Observations,
    GetImage: Image,
    ReviewObservation: ObservationReport,
    GetSessions: Sessions,
    EndSession: SessionReport,
    GetAudit: Audit,
    GetTrajectory: Trajectory,
}
"""What each request of an operator is answered with."""

NOTIFICATIONS: dict[str, type] = {
    "positions": Positions,
    "command": CommandReport,
    "observation": ObservationReport,
    "emergency": EmergencyReport,
    "site": SiteReport,
    "stopping": Stopping,
}
"""What operators are told without asking, by method."""
