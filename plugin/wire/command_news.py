"""What the gateway tells of commands, made so small that a desk can keep thousands."""

from __future__ import annotations

import dataclasses
from typing import Any

from ...robot_bridge.messages import CommandReport, SetPath, command_report
from .path_points import packed

METHOD = "command"


def command_in(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON.

    A path along roads has hundreds of points, which would take 90 kB.
    """
    report = command_report(values)
    if report.op != SetPath.__name__ or "points" not in report.params:
        return report
    return dataclasses.replace(report, params={**report.params, "points": packed(report.params["points"])})


def commands_in(result: dict[str, Any]) -> list[CommandReport]:
    """Return the reports in an answer; oldest first, since get_commands answers with the newest first."""
    if "commands" in result:
        return [command_in(values) for values in reversed(result["commands"])]
    return [command_in(result)] if "command" in result and "op" in result else []
