"""What the gateway tells of observations, from the wire to the desk's book; no QGIS canvas."""

from __future__ import annotations

import json

import pytest
from fleet_supervisor.plugin.gateway_client import report_caches
from fleet_supervisor.plugin.gateway_client.fleet_state import UpdateBuffer
from fleet_supervisor.plugin.gateway_client.protocol import GatewayProtocol
from fleet_supervisor.plugin.gateway_client.report_caches import ObservationCache
from fleet_supervisor.plugin.ui.errors import GatewayLinkError
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.messages.records import ObservationState
from fleet_supervisor.robot_bridge.core.reconnection import GatewayAddresses


def told(number, state="pending", **more):
    values = {
        "observation": number,
        "robot": "r1",
        "op": "SetObject",
        "object": f"bin-{number}",
        "x": 1.0,
        "y": 2.0,
    }
    return {**values, "received_at": 1_790_000_000.0 + number, "state": state, **more}


@pytest.fixture
def mailbox():
    return UpdateBuffer()


@pytest.fixture
def protocol(mailbox):
    return GatewayProtocol("anna", 10.0, GatewayAddresses("ws://here/desk"), mailbox, ManualClock())


def hear(protocol, params):
    protocol.receive(json.dumps({"jsonrpc": "2.0", "method": "observation", "params": params}))


def test_the_newest_of_each_is_kept_until_the_window_looks(protocol, mailbox):
    hear(protocol, told(1))
    hear(protocol, told(2))
    hear(protocol, told(1, "rejected", reviewed_by="bob"))
    found = mailbox.collect().observations
    assert {number: one.state.value for number, one in found.items()} == {1: "rejected", 2: "pending"}
    assert mailbox.collect().observations == {}


def test_what_is_no_observation_ends_the_link_with_its_text(protocol):
    with pytest.raises(GatewayLinkError, match="observation"):
        hear(protocol, {"observation": 1, "state": "lovely", "robot": "r1"})


def book_of(mailbox, protocol, *all_told):
    book = ObservationCache()
    for one in all_told:
        hear(protocol, one)
    return book, book.merge(mailbox.collect().observations)


def test_those_that_wait_come_first_and_the_newest_of_them(mailbox, protocol):
    reviewed = told(4, "accepted")
    book, new = book_of(mailbox, protocol, told(1), reviewed, told(3), told(2, "rejected"))
    assert sorted(new) == [1, 2, 3, 4]
    assert [one.observation for one in book.ordered()] == [3, 1, 4, 2]
    assert book.pending == 2
    hear(protocol, told(3))
    assert book.merge(mailbox.collect().observations) == []


def test_of_very_many_reviewed_ones_the_oldest_are_forgotten_and_none_that_waits(
    mailbox, protocol, monkeypatch
):
    monkeypatch.setattr(report_caches, "MOST_REVIEWED", 2)
    book, _ = book_of(mailbox, protocol, told(1), *(told(n, "accepted") for n in range(2, 7)), told(7))
    assert sorted(one.observation for one in book) == [1, 5, 6, 7]
    assert book.get(1).state is ObservationState.PENDING
