"""The commands that the desk knows of."""

from __future__ import annotations

from collections.abc import Iterable

from ...robot_bridge.messages import Abort, CommandReport, CommandState, SetPath, SetPosEnd

UNDER_WAY = (CommandState.QUEUED, CommandState.DELIVERED, CommandState.ACKNOWLEDGED)
MOST_COMMANDS = 1000


class CommandBook:
    """Commands by id, in the order in which they were first heard of."""

    def __init__(self) -> None:
        self._reports: dict[str, CommandReport] = {}

    def __len__(self) -> int:
        return len(self._reports)

    def merge(self, reports: Iterable[CommandReport]) -> list[CommandReport]:
        """Take in reports and return those that told something new.

        A report with fewer steps than what is known was overtaken on its way and is passed over.
        """
        changed = []
        for report in reports:
            known = self._reports.get(report.command)
            if known is not None and (len(report.steps) < len(known.steps) or report == known):
                continue
            self._reports[report.command] = report
            changed.append(report)
        for command in list(self._reports)[: max(0, len(self._reports) - MOST_COMMANDS)]:
            del self._reports[command]
        return changed

    def clear(self) -> None:
        """Forget every command."""
        self._reports.clear()

    def get(self, command: str) -> CommandReport | None:
        """Return a command, None if it is not known."""
        return self._reports.get(command)

    def under_way(self) -> list[CommandReport]:
        """Return what robots are doing: of each the newest target or path that is not finished."""
        newest: dict[str, CommandReport] = {}
        for report in self._reports.values():
            if report.state in UNDER_WAY and report.op != Abort.__name__:
                newest[report.robot] = report
        return list(newest.values())

    def task_of(self, robot: str) -> CommandReport | None:
        """Return what ``robot`` is doing, None if nothing is known of it."""
        return next((report for report in self.under_way() if report.robot == robot), None)


def in_words(report: CommandReport) -> str:
    """Return what a command asks for, as in ``cone at 12.30, 40.00``."""
    if report.op == SetPosEnd.__name__:
        what = "cone" if report.params.get("cone") else "target"
        return f"{what} at {_metres(report.params.get('x'))}, {_metres(report.params.get('y'))}"
    if report.op == SetPath.__name__:
        return f"route of {len(report.params.get('points', []))} points"
    return {Abort.__name__: "abort"}.get(report.op, report.op)


def _metres(value: object) -> str:
    return f"{value:.2f}" if isinstance(value, (int, float)) else "?"
