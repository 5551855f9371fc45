"""Supervisors keep accounts at the desk: what they ask holds at once, and nobody locks everybody out."""

from __future__ import annotations

import pytest

from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError, is_refused

LAST = "would leave no supervisor"


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


@pytest.fixture
def ada(bridge, accounts_of):
    return bridge.desk(**accounts_of(bridge).operator("Ada", "supervisor"))


def make(desk, operator, role, **more):
    """Make an account; return what its connections are opened with."""
    made = desk.ask("add_operator", {"operator": operator, "role": role, **more})
    assert (made["operator"], made["role"]) == (operator, role)
    return bearing(made["token"])


def state_of(desk, operator):
    return next(o for o in desk.ask("get_operators")["operators"] if o["operator"] == operator)


def test_an_account_made_at_the_desk_opens_it_with_its_role(bridge, ada):
    ben = bridge.desk(**make(ada, "Ben", "viewer"))
    assert (ben.hello["operator"], ben.hello["role"]) == ("Ben", "viewer")
    with pytest.raises(RefusedError, match="Ben is viewer"):
        ben.ask("abort_all")
    assert ada.ask("set_role", {"operator": "Ben", "role": "operator"})["role"] == "operator"
    wait_until(lambda: not is_refused(ben, "abort_all"))


def test_a_rotated_and_a_revoked_token_end_what_they_opened(bridge, ada, close_code):
    first = make(ada, "Ben", "operator")
    before = bridge.desk(**first)
    rotated = bearing(ada.ask("rotate_token", {"operator": "Ben"})["token"])
    assert close_code(before)[0] == 4003
    after = bridge.desk(**rotated)
    assert ada.ask("revoke_token", {"operator": "Ben"})["token"] == "revoked"
    assert close_code(after)[0] == 4003
    assert state_of(ada, "Ben")["token"] == "revoked"
    again = bearing(ada.ask("rotate_token", {"operator": "Ben"})["token"])
    assert bridge.desk(**again).hello["operator"] == "Ben"
    assert state_of(ada, "Ben")["token"] == "valid"


def test_a_token_expires_when_it_was_said_to(bridge, ada, close_code):
    ben = bridge.desk(**make(ada, "Ben", "viewer", expires_in=1.5))
    assert state_of(ada, "Ben")["token"] == "valid"
    assert close_code(ben)[0] == 4003
    assert state_of(ada, "Ben")["token"] == "expired"


def test_a_validity_that_is_none_is_refused_and_makes_no_account(ada):
    for seconds in (0, -1, 1e12):
        with pytest.raises(RefusedError, match="expires_in is"):
            make(ada, "Ben", "viewer", expires_in=seconds)
        assert [o["operator"] for o in ada.ask("get_operators")["operators"]] == ["Ada"]


def test_the_last_supervisor_can_be_taken_away_by_nobody_at_the_desk(bridge, ada):
    for method, more in (("revoke_token", {}), ("set_role", {"role": "operator"})):
        with pytest.raises(RefusedError, match=LAST):
            ada.ask(method, {"operator": "Ada", **more})
    assert (state_of(ada, "Ada")["role"], state_of(ada, "Ada")["token"]) == ("supervisor", "valid")
    make(ada, "Eve", "supervisor")
    assert ada.ask("set_role", {"operator": "Eve", "role": "viewer"})["role"] == "viewer"
    make(ada, "Mia", "supervisor")
    assert ada.ask("revoke_token", {"operator": "Ada"})["token"] == "revoked"


def test_the_first_account_of_an_open_desk_must_be_a_supervisors(bridge, close_code):
    desk = bridge.desk("anybody")
    with pytest.raises(RefusedError, match=LAST):
        make(desk, "Ben", "operator")
    assert desk.ask("get_operators") == {"operators": []}
    ada = make(desk, "Ada", "supervisor")
    assert close_code(desk)[0] == 4003
    assert bridge.desk(**ada).hello["role"] == "supervisor"


def test_what_is_done_to_accounts_is_in_the_audit_log_and_no_token_is(bridge, ada):
    tokens = [make(ada, "Ben", "viewer")]
    tokens.append(bearing(ada.ask("rotate_token", {"operator": "Ben"})["token"]))
    with pytest.raises(RefusedError, match="'Ben' is there already"):
        make(ada, "ben", "operator")

    def entries():
        return ada.ask("get_audit", {"who": "Ada", "limit": 100})["entries"]

    wait_until(lambda: len([entry for entry in entries() if entry["action"] != "login"]) >= 3)
    told = {(e["action"], e["subject"], e["done"]) for e in entries() if e["action"] != "login"}
    assert told == {
        ("add_operator", "Ben", True),
        ("rotate_token", "Ben", True),
        ("add_operator", "ben", False),
    }
    secrets = [t["additional_headers"]["Authorization"].split()[1] for t in tokens]
    kept = bridge.output() + str(entries()) + str(bridge.sql("select * from audit"))
    assert not any(secret in kept for secret in secrets)
    assert not any(secret.encode() in bridge.file.read_bytes() for secret in secrets)
