"""Fences: what concerns a robot is written by the gateway that has it, and by no other."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from collections.abc import Set as AbstractSet
from typing import Any, Protocol

from sqlalchemy import Connection

from ...core.errors import StoreError
from ...core.messages.operator_requests import DeskRequest
from .repositories import robots as stored_robots

CHECK_VALID_S = 2.0
"""seconds for which it counts that this gateway had a robot: what is sent to it later is checked again."""


class FencedError(StoreError):
    """Something of a robot was to be stored that another gateway has by now: nothing of it was."""


class OwnerFence(Protocol):
    """Tells which robots this gateway has. Those methods that take a connection are called in its thread."""

    def owns(self, robot: str) -> bool:
        """Tell whether this gateway has the robot, for all that it knows."""

    def may_command(self, robot: str) -> bool:
        """Tell whether the robot may be set in motion now: this gateway has it, and may trust that."""

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Raise FencedError unless this gateway has all ``robots``, and does until the transaction ends."""

    def held(self, connection: Connection, robots: Sequence[str]) -> AbstractSet[str]:
        """Return those of ``robots`` that this gateway has until the transaction ends."""

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those of its robots ``stored`` that somebody has removed from the database."""

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Have the gateway that has a robot do a request once this transaction is committed."""


class SoleFence:
    """The fence of a gateway that has its database alone: all robots are its own, and nothing is asked."""

    def owns(self, robot: str) -> bool:
        """Return true."""
        return True

    def may_command(self, robot: str) -> bool:
        """Return true."""
        return True

    def check(self, connection: Connection, robots: Collection[str]) -> None:
        """Do nothing."""

    def held(self, connection: Connection, robots: Sequence[str]) -> AbstractSet[str]:
        """Return all of them."""
        return frozenset(robots)

    def missing(self, connection: Connection, stored: AbstractSet[str]) -> set[str]:
        """Return those that are not stored any more."""
        return stored_robots.missing(connection, stored)

    def ask(self, connection: Connection, robot: str, request: DeskRequest[Any], operator: str) -> None:
        """Do nothing: there is no other gateway."""


SOLE_FENCE = SoleFence()
