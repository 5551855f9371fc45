"""What operators' accounts may do."""

from __future__ import annotations

from enum import Enum


class Role(str, Enum):
    """What an operator's account may do; each role may do what the one before it may."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"

    def includes(self, other: Role) -> bool:
        """Tell whether this role may do what ``other`` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)
