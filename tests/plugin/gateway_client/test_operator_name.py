"""The name that a desk says hello with: one that the gateway takes, whatever the login is called."""

from __future__ import annotations

import json

import pytest
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.protocol import GatewayProtocol
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.reconnection import GatewayAddresses


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Ada", "Ada"),
        (" Ada\n", "Ada"),
        ("Ada\nforged\x1b[2J", "Ada forged [2J"),
        ("A" * 200, "A" * 127 + "…"),
    ],
)
def test_it_is_one_line_that_is_not_too_long(name, said):
    (hello,) = GatewayProtocol(
        name, 5.0, GatewayAddresses("ws://127.0.0.1:1"), UpdateBuffer(), ManualClock()
    ).begin()
    assert json.loads(hello)["params"]["operator"] == said
