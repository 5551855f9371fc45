"""The adapter of ROS 2 robots behind a rosbridge server: finds them there and leads each, in one loop."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from pathlib import Path
from typing import ClassVar

from ..base.adapter import Adapter, Command
from ..base.errors import CommandRefusedError
from ..base.link import Link
from ..base.settings import LinkSettings, read_settings
from ..ros.adapter import RosAdapter
from ..ros.geometry import Outgoing
from ..ros.grids import Grids
from ..ros.masks import Masks
from ..ros.notes import RobotNotes
from ..ros.robot import RosRobot
from ..ros.sensing import Sensing
from .acting import Acting
from .connection import RosbridgeConnection
from .goal_book import GoalBook
from .goals import ActionGoals
from .graph import Graph, GraphWatch
from .json_messages import JsonMessages, encode
from .listening import Listening
from .settings import RosbridgeSettings, Server, check, server_of

EVERY = 0.02
"""seconds between two looks at what has come."""


class RosbridgeAdapter(RosAdapter[Graph]):
    """The robots behind one rosbridge server; ``file`` is where it notes the goals that it has sent."""

    kind: ClassVar[str] = "rosbridge"

    def __init__(self, settings: RosbridgeSettings, server: Server, file: Path) -> None:
        super().__init__(settings, RobotNotes(file), keeps_servers=False)
        self._settings = settings
        self._connection = RosbridgeConnection(server)
        self._watch = GraphWatch(self._connection, self._written, self._watched)
        self._books = self._notes.read(GoalBook.from_json)
        self._acting: list[Acting] = []
        self._goals: list[ActionGoals] = []

    async def run(self, link: Link) -> None:
        """Lead the robots behind the server until cancelled."""
        work = (self._connection.run(), self._watch.run(), self._lead_all(link))
        tasks = [asyncio.create_task(one) for one in work]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def command(self, command: Command) -> None:
        """Have a robot take on a command."""
        if self._connection.away is not None:
            raise CommandRefusedError(self._connection.away)
        await super().command(command)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Stop a robot; without the server it is asked as soon as that is there."""
        try:
            await super().stop(robot, emergency=emergency)
        except CommandRefusedError as error:
            away = self._connection.away
            raise CommandRefusedError(f"{error}; {away}" if away else str(error)) from None

    async def _lead_all(self, link: Link) -> None:
        settings = self._settings
        outgoing = Outgoing(JsonMessages(settings.distribution), link.frame, settings.map_frame)
        grids = Grids(encode, outgoing, settings.map_resolution_m)
        masks = Masks(encode, outgoing, settings.map_resolution_m, link)

        def make(name: str) -> RosRobot[Graph]:
            sensing = Sensing(name, settings, link.frame)
            goals = ActionGoals(name, self._connection, self._book(name), self._note_goals)
            acting = Acting(name, settings, self._connection, outgoing, goals)
            self._acting.append(acting)
            self._goals.append(goals)
            listening = Listening(sensing, settings, self._connection)
            return RosRobot(name, settings, link, sensing, listening, acting, grids, masks)

        for name in settings.robots:
            self._meet(name, make)
        looks = 0
        while True:
            now = time.monotonic()
            if self._watch.looks != looks:
                looks = self._watch.looks
                known = len(self._robots)
                self._find(list(self._watch.graph.topics), self._watch.graph, make)
                if len(self._robots) > known:
                    self._watch.look_soon()
            for robot in self._robots.values():
                self._lead(robot, partial(robot.step, now))
            self._report(link)
            await asyncio.sleep(max(0.001, EVERY - (time.monotonic() - now)))

    def _network_faults(self) -> list[str]:
        return [*self._connection.faults, *([self._watch.fault] if self._watch.fault else [])]

    def _written(self) -> list[str]:
        return [topic for acting in self._acting for topic in acting.written]

    def _watched(self) -> list[str]:
        return [topic for goals in self._goals for topic in goals.watched]

    def _book(self, robot: str) -> GoalBook:
        return self._books.setdefault(robot, GoalBook())

    def _note_goals(self) -> None:
        """Write down which goals are open, so that the next process of this link sends none of them twice."""
        noted = {robot: rows for robot, book in self._books.items() if (rows := book.to_json())}
        self._notes.write(noted)


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter that goes by them; raises LinkError."""
    settings, own = read_settings(file, "rosbridge", RosbridgeSettings)
    check(settings, own)
    state = settings.state_folder / f"{settings.name}.goals"
    return settings, RosbridgeAdapter(own, server_of(settings, own), state)
