"""Roads and traffic at work, put together: ways found, roads kept closed, robots led round one another."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..commanding.book import CommandBook
from ..commanding.orders import Orders
from ..messages import CommandReport
from ..monitoring.tasks import Steps
from ..robots import Robots
from ..served_site import ServedSite
from ..store.database import Database
from .closure_book import ClosureBook
from .detours import Detours, Queues
from .road_planning import RoadPlanner
from .traffic_control import TrafficControl
from .waiting_robots import WaitingRobots
from .ways import Ways


class Roads:
    """The ways that robots are on, the roads that are closed to them, and who waits for whom.

    ``planner`` is None where the gateway plans without roads. ``announce`` tells every operator.
    """

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        commands: CommandBook,
        orders: Orders,
        queues: Queues,
        database: Database,
        clock: Callable[[], float],
        planner: RoadPlanner | None,
        announce: Callable[[str, str, dict[str, Any]], None],
    ) -> None:
        self.planner = planner
        self._steps = Steps("roads")
        self.ways = Ways(robots, commands)
        detours = Detours(
            self.ways, planner, orders, queues, commands, lambda: site.settings.routes.no_way == "stop"
        )
        self.closures = ClosureBook(database, clock, planner, detours, announce)
        self.waiting = WaitingRobots(database, commands, detours)
        self.traffic = TrafficControl(
            clock,
            robots,
            self.ways,
            planner,
            detours,
            self.waiting,
            lambda: site.site,
            announce,
        )

    async def restore(self) -> None:
        """Go on with the closed roads and the waiting robots that an earlier gateway left."""
        await self.closures.restore()
        await self.waiting.restore()

    def note_step(self, command: CommandReport) -> None:
        """Note a step of a command; called with each."""
        self.waiting.note_step(command)

    async def watch(self, *, listened_to: bool) -> None:
        """Open roads that were closed until now; see to robots on closed ones, and in each other's way.

        Conflicts are looked for only while operators are ``listened_to`` be told of them.
        """
        await self._steps.run(
            {
                "closed roads": self.closures.expire,
                "detours": self.closures.catch_up,
                "traffic": lambda: self.traffic.watch(listened_to=listened_to),
            }
        )
