"""What supervisors ask about operators' accounts: who has one, with which role, and how its token stands."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from .checks import check_expires_in
from .roles import Role

LONGEST_VALIDITY = 3660 * 86400.0
"""seconds."""


class TokenState(str, Enum):
    """How an operator's newest token stands; ``none`` where there never was one."""

    VALID = "valid"
    EXPIRED = "expired"
    REVOKED = "revoked"
    NONE = "none"


@dataclass(frozen=True)
class GetOperators:
    """Ask for every operator's account, by name."""

    method: ClassVar[str] = "get_operators"


@dataclass(frozen=True)
class AddOperator:
    """Make an account; answered with its token. That expires after ``expires_in`` seconds, if given."""

    method: ClassVar[str] = "add_operator"
    operator: str
    role: Role
    expires_in: float | None = None

    def __post_init__(self) -> None:
        check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class RotateToken:
    """Ask for a new token of an operator, in place of every one before, whose connections end."""

    method: ClassVar[str] = "rotate_token"
    operator: str
    expires_in: float | None = None

    def __post_init__(self) -> None:
        check_expires_in(self.expires_in, LONGEST_VALIDITY)


@dataclass(frozen=True)
class RevokeToken:
    """Take an operator's token away; connections that it opened end. The account stays."""

    method: ClassVar[str] = "revoke_token"
    operator: str


@dataclass(frozen=True)
class SetRole:
    """Give an operator another role, which holds for open connections too."""

    method: ClassVar[str] = "set_role"
    operator: str
    role: Role


@dataclass(frozen=True)
class OperatorReport:
    """An account and how its newest token stands; times are seconds since 1970."""

    operator: str
    role: Role
    created_at: float
    token: TokenState
    expires_at: float | None = None
    revoked_at: float | None = None
    used_at: float | None = None


@dataclass(frozen=True)
class NewToken:
    """A token that was just made. It is kept nowhere, and told in this answer only."""

    operator: str
    role: Role
    token: str
    expires_at: float | None = None


@dataclass(frozen=True)
class Operators:
    """Every operator's account, by name."""

    operators: list[OperatorReport]
