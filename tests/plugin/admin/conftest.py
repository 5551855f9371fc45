"""A small gateway that keeps accounts, and the window over them."""

from __future__ import annotations

import pytest
from fleet_supervisor.robot_bridge.core.messages.administration import (
    NewToken,
    OperatorReport,
    Operators,
    SessionReport,
    TokenState,
)
from fleet_supervisor.robot_bridge.core.messages.base import Role, to_json

from tests.plugin.admin.accounts_desk import MADE_AT, AccountsDesk


def secret(number: int) -> str:
    """A token as long as a real one."""
    return f"fleet_op_{number:043d}"


class AccountBook:
    """Answers what a gateway does about accounts; ``accounts`` are its own, by name."""

    def __init__(self, gateway, own: str):
        self.accounts: dict[str, OperatorReport] = {}
        self.made: list[str] = []
        """The tokens that it told."""
        self._own = own
        gateway.answers.update(
            get_operators=lambda _: {"result": to_json(Operators(list(self.accounts.values())))},
            get_sessions=lambda _: {"result": {"sessions": [to_json(self._session())]}},
            add_operator=lambda params: self._new_token(params["operator"], Role(params["role"]), params),
            rotate_token=lambda params: self._new_token(params["operator"], None, params),
            set_role=lambda params: self._change(params["operator"], role=Role(params["role"])),
            revoke_token=lambda params: self._change(
                params["operator"], token=TokenState.REVOKED, revoked_at=MADE_AT + 120
            ),
        )

    def put(self, name: str, role: Role, **more) -> None:
        """Have an account; a new one where there is one of that name."""
        self.accounts[name] = OperatorReport(name, role, MADE_AT, more.pop("token", TokenState.VALID), **more)

    def _session(self) -> SessionReport:
        return SessionReport("9f86", self._own, "supervisor", "127.0.0.1", MADE_AT)

    def _new_token(self, name: str, role: Role | None, params: dict) -> dict:
        self.made.append(secret(len(self.made)))
        self.put(name, role or self.accounts[name].role)
        ends = params.get("expires_in")
        made = NewToken(name, self.accounts[name].role, self.made[-1], ends and MADE_AT + ends)
        return {"result": to_json(made)}

    def _change(self, name: str, **changes) -> dict:
        self.accounts[name] = OperatorReport(**{**vars(self.accounts[name]), **changes})
        return {"result": to_json(self.accounts[name])}


@pytest.fixture
def book(gateway):
    """Accounts of Ada, who is the desk's operator, and of Ben."""
    gateway.who = {"operator": "Ada", "role": "supervisor"}
    book = AccountBook(gateway, "Ada")
    book.put("Ada", Role.SUPERVISOR, used_at=MADE_AT + 60)
    book.put("Ben", Role.VIEWER, used_at=MADE_AT + 60, expires_at=MADE_AT + 86_400)
    return book


@pytest.fixture
def operator(plugin, iface, gateway, wait):
    return AccountsDesk(plugin, iface, gateway, wait)


@pytest.fixture
def at_accounts(operator, book):
    """Connected, with the window open and both accounts listed."""
    operator.connect()
    operator.open()
    operator.listed("Ada", "Ben")
    return operator
