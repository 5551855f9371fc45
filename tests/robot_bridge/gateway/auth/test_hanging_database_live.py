"""Who gets in, and stops the fleet, while the database server does not answer; real programs."""

from __future__ import annotations

import pytest

from robot_bridge.gateway.auth.accounts import TokenKind, new_token
from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.frozen_server import frozen
from tests.support.wire import is_shut


@pytest.fixture
def bridge(start_bridge, sample_site, new_database):
    bridge = start_bridge(sample_site, new_database("postgresql"))
    yield bridge
    bridge.end()


def test_a_known_operator_stops_the_fleet_and_an_unknown_one_is_answered(
    bridge, accounts_of, refused, postgresql_server
):
    ada = accounts_of(bridge).operator("Ada", "supervisor")
    wait_until(lambda: is_shut(bridge.desk))
    robot = bridge.robot("r1")
    robot.plug_in(1)
    with frozen(postgresql_server):
        status, text = refused(lambda: bridge.desk(**bearing(new_token(TokenKind.OPERATOR))))
        assert (status, text[:31]) == (503, "The accounts cannot be read now")
        desk = bridge.desk(**ada)
        state = desk.ask("emergency_stop", {"command": "stop-0001", "reason": "smoke"}, 30.0)
        assert (state["in_force"], state["stored"]) == (True, False)
        assert robot.wait_for("Abort")["id"] == "emergency-stop-0001"
    desk.until(lambda: desk.emergency["stored"], 60.0)
