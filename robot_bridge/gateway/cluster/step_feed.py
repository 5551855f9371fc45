"""Steps of commands at other gateways, told to the operators of this one: looked up each second."""

from __future__ import annotations

from ...core.messages.commands import CommandReport
from ...core.messages.json_values import to_json
from ..model.events import CommandChanged, EventBus, Listeners
from ..model.robots import Robots
from ..storage.database import Database
from ..storage.repositories import commands
from .exchange import Exchange
from .follower import Follower


class StepFeed:
    """Follows the steps of commands of others' robots, and wakes others when robots here take one."""

    def __init__(
        self, robots: Robots, listeners: Listeners, events: EventBus, exchange: Exchange, database: Database
    ) -> None:
        self._robots = robots
        self._listeners = listeners
        self._database = database
        self._newest: int | None = None
        self._seen: set[int] = set()
        self._follower = Follower("steps", self, exchange)
        events.subscribe(CommandChanged, self._note)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Tell operators of the steps since the last look; raises StoreError."""
        if self._newest is None:
            self._newest = await self._database.read(commands.newest_step)
            self._seen = {id for id, _ in await self._database.read(commands.steps_after, self._margin())}
            return
        found = await self._database.read(commands.steps_after, self._margin())
        new = list(dict.fromkeys(command for id, command in found if id not in self._seen))
        reports = await self._database.read(commands.find_all, new) if new else {}
        for command in new:
            if command in reports:
                self._tell(reports[command].report)
        self._newest = max([self._newest, *(id for id, _ in found)])
        self._seen = {id for id in self._seen | {id for id, _ in found} if id > self._margin()}

    def _margin(self) -> int:
        return (self._newest or 0) - commands.STEP_MARGIN

    def _tell(self, report: CommandReport) -> None:
        if self._robots.gateway_of(report.robot) is None:
            return
        doing = self._robots.get(report.robot).command
        if report.state.is_open:
            self._robots.assign(report.robot, report.command)
        elif doing == report.command:
            self._robots.assign(report.robot, None)
        self._listeners.announce("command", report.command, to_json(report))

    def _note(self, changed: CommandChanged) -> None:
        if self._robots.gateway_of(changed.report.robot) is None:
            self._follower.note_change()
