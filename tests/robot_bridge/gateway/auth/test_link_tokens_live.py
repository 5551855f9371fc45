"""Tokens of links: who may speak for whom, while it runs."""

from __future__ import annotations

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError, Wire


@pytest.fixture(scope="module")
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


@pytest.fixture(scope="module")
def accounts(accounts_of, bridge):
    return accounts_of(bridge)


def link(bridge, **options):
    wire = Wire(f"{bridge.address}/link", **options)
    wire._hear = lambda _frame: None
    return wire


def hello(wire):
    return wire.ask("hello", {"protocol": 1, "kind": "test"})


def test_a_link_speaks_for_its_robots_and_no_others_until_it_is_revoked(bridge, accounts):
    token = accounts.do("links", "add", "agvs", "--robots", "agv-*", "--robots", "cart-?")
    wait_until(lambda: is_shut(bridge))
    wire = link(bridge, **bearing(token))
    assert (hello(wire)["link"], hello(wire)["robots"]) == ("agvs", ["agv-*", "cart-?"])
    for robot in ("agv-1", "cart-1"):
        assert wire.ask("Ready", {"robot": robot, "magic": 1, "abilities": []})["robot"] == robot
    with pytest.raises(RefusedError, match="may not speak for robot 'cart-12', only for agv-"):
        wire.ask("Ready", {"robot": "cart-12", "magic": 1})

    accounts.do("links", "robots", "agvs", "--robots", "cart-*")
    released = []
    wire._hear = released.append
    wire.until(lambda: any(frame["method"] == "Released" for frame in released))
    assert released[-1]["params"]["robot"] == "agv-1"
    assert wire.ask("Ready", {"robot": "cart-12", "magic": 1, "abilities": []})["robot"] == "cart-12"

    assert "agvs\tcart-*\tvalid" in accounts.do("links", "list")
    accounts.do("links", "revoke", "agvs")
    with pytest.raises(ConnectionClosed) as closed:
        wire.until(lambda: False)
    assert closed.value.rcvd.code == 4003
    noted = accounts.do("audit")
    assert "links add" in noted and "links revoke" in noted and "link agvs" in noted


def test_a_token_opens_its_own_door_only(bridge, accounts):
    token = accounts.do("links", "add", "ros", "--robots", "*")
    robot = accounts.robot("r1")
    accounts.operator("Ada", "supervisor")
    for path, options in (("/robot", bearing(token)), ("/desk", bearing(token)), ("/link", robot)):
        wait_until(lambda path=path, options=options: is_refused(bridge, path, options))
    with pytest.raises(InvalidStatus) as other:
        Wire(f"{bridge.address}/link?link=agvs", **bearing(token))
    assert other.value.response.status_code == 403


def test_where_robots_need_tokens_so_do_links(bridge, accounts, start_bridge, sample_site, accounts_of):
    other = start_bridge(sample_site)
    assert hello(link(other))["robots"] == ["*"]
    accounts_of(other).robot("r1")
    wait_until(lambda: is_shut(other))
    other.end()


def is_shut(bridge):
    return is_refused(bridge, "/link", {})


def is_refused(bridge, path, options):
    try:
        Wire(f"{bridge.address}{path}", **options).connection.close()
    except InvalidStatus as error:
        return error.response.status_code == 401
    return False


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("sql", "--robots", "*"), "link name 'sql' cannot be used"),
        (("x" * 17, "--robots", "*"), "1 to 16 letters"),
        (("ok", "--robots", "a b"), "is no pattern of robots' names"),
        (("Ros", "--robots", "*"), "is there already"),
    ],
)
def test_accounts_that_cannot_be_are_refused(accounts, words, reason):
    accounts.run("links", "add", "ros", "--robots", "*")
    done = accounts.run("links", "add", *words)
    assert done.returncode == 1 and reason in done.stderr
