"""A web page's script logs in by a subprotocol, since it can send no header with its token; real programs."""

from __future__ import annotations

import json

import pytest
from websockets.sync.client import connect

from robot_bridge.core.errors import AccessError
from robot_bridge.gateway.auth.accounts import TokenKind, chosen_protocol, new_token, token_in
from tests.support.bridge.bridge_accounts import bearing
from tests.support.bridge.bridge_programs import wait_until
from tests.support.patience import START

PAGE = "https://fleet.example.org"
OTHER = "https://evil.example.org"


@pytest.fixture(scope="module")
def bridge(start_bridge, limited_site):
    return start_bridge(limited_site(f'[limits]\norigins = ["{PAGE}"]\n'))


@pytest.fixture(scope="module")
def tokens(bridge, accounts_of):
    """The tokens of a supervisor and of robot r1."""
    accounts = accounts_of(bridge)
    opened_with = accounts.operator("Ada", "supervisor"), accounts.robot("r1")
    return [one["additional_headers"]["Authorization"].removeprefix("Bearer ") for one in opened_with]


def open_page(bridge, path, *offered, origin=PAGE):
    return connect(f"{bridge.address}{path}", origin=origin, subprotocols=offered or None)


def test_a_page_comes_in_with_its_token_as_a_subprotocol_and_is_not_sent_it_back(bridge, tokens):
    desk, robot = tokens
    with open_page(bridge, "/desk", "robot-bridge", f"token.{desk}") as page:
        assert page.subprotocol == "robot-bridge"
        assert desk not in str(page.response.headers)
        hello = {"jsonrpc": "2.0", "id": 1, "method": "hello", "params": {"protocol": 1, "operator": "x"}}
        page.send(json.dumps(hello))
        # What all desks are told may come first.
        answer = next(one for one in map(json.loads, page) if one.get("id") == 1)
        result = answer.get("result", answer)
        assert (result["operator"], result["role"]) == ("Ada", "supervisor")
    with open_page(bridge, "/robot", f"token.{robot}", "robot-bridge") as page:
        assert page.subprotocol == "robot-bridge"
        assert json.loads(page.recv(START))["method"] == "Start"


def test_who_offers_other_protocols_is_answered_with_none(bridge, tokens):
    with connect(f"{bridge.address}/desk", subprotocols=["chat"], **bearing(tokens[0])) as page:
        assert page.subprotocol is None


def test_the_page_of_another_origin_is_refused_whatever_it_brings(bridge, tokens, refused):
    offered = "robot-bridge", f"token.{tokens[0]}"
    status, text = refused(lambda: open_page(bridge, "/desk", *offered, origin=OTHER))
    assert (status, text[:9]) == (403, "Web pages")


def test_a_wrong_token_is_refused_and_no_log_holds_any(bridge, tokens, refused):
    desk, robot = tokens
    unknown = new_token(TokenKind.OPERATOR)
    for token, says in (
        (unknown, "This token is not known"),
        (robot, "This token is a robot's, and /desk takes an operator's"),
    ):
        status, text = refused(lambda: open_page(bridge, "/desk", "robot-bridge", f"token.{token}"))  # noqa: B023
        assert (status, text[: len(says)]) == (401, says)
    for offers in (f"robot-bridge, token.{desk}/=", f"token.{desk}"):
        headers = {"Sec-WebSocket-Protocol": offers}
        status, text = refused(lambda: connect(f"{bridge.address}/desk", additional_headers=headers))  # noqa: B023
        assert status == 400 and desk not in text
    wait_until(lambda: "this token is not known" in bridge.output())
    log = bridge.output()
    secrets = [token.split("_", 2)[2] for token in (desk, robot, unknown)]
    assert not [secret for secret in secrets if secret[:12] in log]


@pytest.mark.parametrize(
    ("authorizations", "offers", "token"),
    [
        ([], [], None),
        ([], ["chat, robot-bridge"], None),
        ([], ["robot-bridge,\ttoken.fleet_op_a-B_9"], "fleet_op_a-B_9"),
        ([], ["token.a", "robot-bridge"], "a"),
        ([], ["robot-bridge, token."], None),
        (["Bearer a"], ["robot-bridge"], "a"),
    ],
)
def test_the_token_is_found_wherever_it_may_be(authorizations, offers, token):
    assert token_in(authorizations, offers) == token


@pytest.mark.parametrize(
    ("authorizations", "offers", "said"),
    [
        (["Bearer a", "Bearer b"], [], "several Authorization headers"),
        (["Bearer a"], ["robot-bridge, token.b"], "carries several tokens"),
        ([], ["robot-bridge, token.a, token.b"], "carries several tokens"),
        ([], ["token.a"], "offer robot-bridge beside it"),
        ([], ["robot-bridge, token.a b"], "no name of a protocol"),
        ([], ["robot-bridge, token.\u00e4"], "no name of a protocol"),
        ([], [""], "no name of a protocol"),
    ],
)
def test_what_may_mean_any_token_is_refused(authorizations, offers, said):
    with pytest.raises(AccessError, match=said):
        token_in(authorizations, offers)


def test_a_token_is_never_the_protocol_that_is_chosen():
    assert chosen_protocol(["token.a"]) is None
    assert chosen_protocol(["token.a", "robot-bridge"]) == "robot-bridge"
