"""Whether the robot of a draft can do what the draft asks of it, as it said when it connected."""

from __future__ import annotations

from ....robot_bridge.messages import Ability
from ...language import tr
from ..drafts import CONE, ROUTE, START, TARGETS, Draft, Findings
from ..picture import RobotView

_NEEDED: dict[str, Ability] = {CONE: "targets", TARGETS: "targets", ROUTE: "paths", START: "start"}


def has(robot: RobotView | None, ability: Ability) -> bool:
    """Tell whether a robot did not say that it cannot do this."""
    abilities = None if robot is None else robot.told.get("abilities")
    return abilities is None or ability in abilities.split()


def check_abilities(draft: Draft, robot: RobotView | None) -> Findings:
    """Refuse what the draft's ``robot`` cannot do; warn where it goes to a cone target without a cone."""
    if robot is None or robot.told.get("abilities") is None:
        return Findings()
    if not robot.told["abilities"]:
        return Findings(refused=(tr("{robot} is only seen: it takes no commands.", robot=draft.robot),))
    if not has(robot, _NEEDED[draft.kind]):
        texts = {
            ROUTE: tr("{robot} cannot follow routes.", robot=draft.robot),
            START: tr("{robot} cannot be told where it starts.", robot=draft.robot),
        }
        otherwise = tr("{robot} cannot be sent to targets.", robot=draft.robot)
        return Findings(refused=(texts.get(draft.kind, otherwise),))
    if has(robot, "cones"):
        return Findings()
    if draft.kind == TARGETS:
        return Findings(refused=(tr("{robot} places no cones.", robot=draft.robot),))
    if draft.kind == CONE:
        return Findings(warnings=(tr("{robot} places no cones: it only drives there.", robot=draft.robot),))
    return Findings()
