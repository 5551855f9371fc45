"""What supervisors are told survives the wire, also from a gateway that tells more."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.messages.administration import (
    NewToken,
    OperatorReport,
    Operators,
    SessionReport,
    SiteOffer,
    Sites,
    TokenState,
    new_token,
    open_session,
    operators_report,
    sites_report,
)
from robot_bridge.core.messages.base import Role, to_json

ADA = OperatorReport("Ada", Role.SUPERVISOR, 100.0, TokenState.VALID, used_at=150.5)
BEN = OperatorReport("Ben", Role.VIEWER, 200.0, TokenState.REVOKED, expires_at=400.0, revoked_at=300.0)


@pytest.mark.parametrize(
    ("message", "read"),
    [
        (Operators([ADA, BEN]), operators_report),
        (NewToken("Ben", Role.OPERATOR, "fleet_op_x", 400.0), new_token),
        (SessionReport("9f86", "Ada", "supervisor", "127.0.0.1", 100.0), open_session),
        (
            Sites([SiteOffer("north", True, "n", "North", 3), SiteOffer("x", False, refusal="no")]),
            sites_report,
        ),
    ],
)
def test_it_is_read_as_it_was_written(message, read):
    values = json.loads(json.dumps(to_json(message)))
    assert read(values) == message
    assert read({**values, "of a newer gateway": 1}) == message


def test_what_is_read_has_types_of_its_own():
    (ada, _) = operators_report(to_json(Operators([ADA, BEN]))).operators
    assert isinstance(ada.role, Role) and isinstance(ada.token, TokenState)


def test_an_account_of_a_role_that_nobody_knows_is_not_read_as_another():
    values = to_json(Operators([ADA]))
    values["operators"][0]["role"] = "admiral"
    with pytest.raises(ValueError, match="admiral"):
        operators_report(values)
