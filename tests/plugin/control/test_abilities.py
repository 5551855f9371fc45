"""Drafts for robots that said what they can do: the rest is refused with the reason, before it is sent."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control.command_checks import check_abilities
from fleet_supervisor.plugin.control.pending_command import CONE, ROUTE, START, TARGETS, PendingCommand
from fleet_supervisor.plugin.gateway_client.robot_states import RobotView
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState

POINTS = ((1.0, 2.0), (3.0, 4.0))


def found(kind, abilities):
    told = {} if abilities is None else {"abilities": abilities}
    robot = RobotView("r1", told, RobotState.FRESH, 0.0)
    return check_abilities(PendingCommand("r1", kind, POINTS), robot)


@pytest.mark.parametrize("kind", [CONE, ROUTE, START, TARGETS])
def test_a_robot_that_declared_nothing_can_do_everything(kind):
    assert found(kind, None).faults == found(kind, "cones paths start targets").faults == ()


@pytest.mark.parametrize(
    ("kind", "abilities", "reason"),
    [
        (CONE, "", "r1 is only seen: it takes no commands."),
        (ROUTE, "targets", "r1 cannot follow routes."),
        (START, "targets paths", "r1 cannot be told where it starts."),
        (CONE, "paths", "r1 cannot be sent to targets."),
        (TARGETS, "targets", "r1 places no cones."),
    ],
)
def test_what_a_robot_cannot_do_is_refused_with_the_reason(kind, abilities, reason):
    assert found(kind, abilities).refused == (reason,)


def test_a_robot_that_places_no_cones_is_sent_to_a_cone_target_without_one():
    assert found(CONE, "targets").warnings == ("r1 places no cones: it only drives there.",)
    assert found(CONE, "targets").refused == ()
    op, params = PendingCommand("r1", CONE, POINTS[:1], places_cone=False).message()
    assert (op, params["cone"]) == ("SetPosEnd", False)
