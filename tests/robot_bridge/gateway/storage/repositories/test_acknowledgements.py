"""What is read of OpAcks that wait while an emergency stop is made: little of a robot that wrote many."""

from __future__ import annotations

import pytest

from robot_bridge.core.json_decoder import SHORT
from robot_bridge.gateway.storage.repositories import requests


@pytest.fixture
def decoded(monkeypatch):
    """Every text that is decoded."""
    texts, decode_json = [], requests.decode_json

    def noting(text, bounds):
        texts.append(text)
        return decode_json(text, bounds)

    monkeypatch.setattr(requests, "decode_json", noting)
    return texts


def write(connection, *acks, robot="r1"):
    requests.add_requests(connection, [(robot, "OpAck", ack, None) for ack in acks])


def test_what_is_longer_than_any_acknowledgement_is_not_even_decoded(connection, decoded):
    write(
        connection,
        "[" * 30_000 + "]" * 30_000,
        '{"id": 7}',
        '{"id": 8, "reason": "' + "x" * SHORT.length + '"}',
    )
    assert requests.acknowledged(connection, ["r1"]) == {"r1": {7}}
    assert decoded == ['{"id": 7}']


def test_of_a_robot_that_wrote_thousands_some_are_decoded_and_of_others_all(connection, decoded):
    write(connection, *["{}"] * (requests.MOST_ACKS + 100), '{"id": 9}')
    write(connection, '{"id": 3}', '{"id": 4}', robot="r2")
    assert requests.acknowledged(connection, ["r1", "r2"]) == {"r1": set(), "r2": {3, 4}}
    assert len(decoded) == requests.MOST_ACKS + 2


def test_the_backlog_ends_with_the_newest_request_of_anybody(connection):
    assert requests.backlog(connection, ["r1"]) == (0, {"r1": set()})
    write(connection, '{"id": 3}')
    requests.add_requests(connection, [("r2", "Alive", "{}", None)])
    assert requests.backlog(connection, ["r1"]) == (2, {"r1": {3}})
    write(connection, '{"id": 4}')
    assert requests.acknowledged(connection, ["r1"], newest=2) == {"r1": {3}}
