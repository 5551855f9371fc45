"""Permission check of operators' requests: the least role of each, and of what overrides a check."""

from __future__ import annotations

from typing import Any

from ...core.errors import ForbiddenError
from ...core.messages import DeskRequest, Role


def check_permission(request: DeskRequest[Any], operator: str, role: Role, override_role: Role) -> None:
    """Raise ForbiddenError for a request, or an override in it, that an operator's role does not reach.

    ``override_role`` is the least role that may override a check, by the site's settings.
    """
    if not role.includes(request.least_role):
        raise ForbiddenError(
            f"{request.method}: {operator} is {role.value}, and this takes {request.least_role.value}; "
            "ask one, or have the role changed by 'robot-bridge operators role'"
        )
    if getattr(request, "override", None) is not None and not role.includes(override_role):
        raise ForbiddenError(
            f"{request.method}: {operator} is {role.value}, and an override takes {override_role.value}; "
            "choose another place or way, or ask one (override_role in the site's settings)"
        )
