"""Operators' roles in the operator's language."""

from __future__ import annotations

from ...robot_bridge.messages import Role
from ..language import tr

ROLES = {
    Role.VIEWER: tr("viewer"),
    Role.OPERATOR: tr("operator"),
    Role.SUPERVISOR: tr("supervisor"),
}


def role_in_words(role: str) -> str:
    """Return a role by its name on the wire; one that is not known here as it is."""
    return next((words for known, words in ROLES.items() if known.value == role), role)
