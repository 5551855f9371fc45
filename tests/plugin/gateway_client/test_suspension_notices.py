"""A robot's account that is locked: named in the message bar as long as it is, and not longer."""

from __future__ import annotations

import json

from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.protocol import GatewayProtocol
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.reconnection import GatewayAddresses


def told(desk, *robots):
    """Have the desk hear what a gateway sends."""
    mailbox = UpdateBuffer()
    mailbox.add(link=desk.state.link)
    frame = {"jsonrpc": "2.0", "method": "suspensions", "params": {"robots": list(robots)}}
    GatewayProtocol("Ada", 1.0, GatewayAddresses("ws://gateway/desk"), mailbox, ManualClock()).receive(
        json.dumps(frame)
    )
    desk.state.merge(mailbox.collect())


def test_what_is_locked_hangs_there_until_it_is_unlocked(at_desk):
    locked = {"robot": "r7", "reason": "it blocks", "until": 1790000060.0}
    told(at_desk.desk, locked)
    (text,) = at_desk.notices.texts()
    assert text.startswith("The database account of robot r7 is locked until ")
    assert "Nothing but a stop reaches it: Abort unlocks the account" in text
    told(at_desk.desk, locked, {"robot": "r8", "reason": "it blocks", "of a newer gateway": 1})
    assert at_desk.notices.texts()[0] == text
    assert at_desk.notices.texts()[1].startswith("The program of robot r8 keeps all others waiting")
    told(at_desk.desk)
    assert at_desk.notices.texts() == []
