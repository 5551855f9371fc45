"""Connections as a file: what is written is read again, and what cannot be read says where and why."""

from __future__ import annotations

import json

import pytest
from fleet_supervisor.plugin.settings.profile import GatewayConnection, connections_in, connections_text
from fleet_supervisor.plugin.ui.errors import FleetError

YARD = GatewayConnection("Yard", "wss://yard:8765/desk", "anna", "/site/ca.pem", "abc1234")


def test_what_is_written_is_read_again_without_what_this_computer_alone_knows():
    text = connections_text([YARD, GatewayConnection("Győr / 2", "ws://127.0.0.1:1/desk")])
    assert "abc1234" not in text
    read = connections_in(text, "file.json")
    assert [(one.name, one.url, one.operator, one.ca_file, one.auth) for one in read] == [
        ("Yard", "wss://yard:8765/desk", "anna", "/site/ca.pem", ""),
        ("Győr / 2", "ws://127.0.0.1:1/desk", "", "", ""),
    ]


def changed(**how):
    return json.dumps({**json.loads(connections_text([YARD])), **how})


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<xml/>", "is not JSON"),
        ("[" * 100_000, "is not JSON"),
        (" " * 200_001, "more than 200000"),
        ("[]", "holds no connections"),
        ("{}", "holds no connections"),
        (changed(version=2), "is of version 2"),
        (changed(connections={}), "no list named connections"),
        (changed(connections=["Yard"]), "connection 1 is not a set of texts"),
        (changed(connections=[{"name": 5, "url": "ws://a/desk"}]), "connection 1 is not a set of texts"),
        (changed(connections=[{"name": "Yard", "url": "http://a"}]), "connection 1: .*begins with http"),
        (changed(connections=[{"name": " ", "url": "ws://a/desk"}]), "connection 1: .*has no name"),
    ],
)
def test_what_is_no_file_of_connections_is_refused_with_place_and_reason(text, says):
    with pytest.raises(FleetError, match=says) as caught:
        connections_in(text, "file.json")
    assert str(caught.value).startswith("file.json")


def test_blanks_around_values_do_not_count():
    made = GatewayConnection("  North   yard ", " ws://a/desk ", " anna ").checked()
    assert (made.name, made.url, made.operator) == ("North yard", "ws://a/desk", "anna")
