"""Maps on their way to robots: what there is at once, and what follows when more is known."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Iterable

from .errors import StoreError
from .exchange import WHOLE_SITE, Outcome
from .mailboxes import Mailboxes
from .messages import RobotState, SetMap
from .monitoring.unforeseen import note_unforeseen
from .robotmap.model import Border, EncodedMap
from .robots import Robots
from .served_site import ServedSite
from .store import tracks
from .store.database import Database

log = logging.getLogger(__name__)

RETRY_AFTER = 1.0
"""seconds after which a map that could not be stored is stored once more."""

Place = tuple[float, float]


class MapSending:
    """Sends robots the map of the whole site, or that of a window around them where the whole is too large.

    A robot never waits for a map to be made: it is sent a window, and the whole one when it is there.
    """

    def __init__(self, site: ServedSite, robots: Robots, mailboxes: Mailboxes, database: Database) -> None:
        self._site = site
        self._robots = robots
        self._mailboxes = mailboxes
        self._database = database
        self._parts: dict[str, Border] = {}
        """what the newest map of a robot covers that was not sent the whole one."""
        self._making = asyncio.Lock()
        self._unplaced: set[str] = set()
        """robots that have such a map, and are still to say where they are."""

    async def first(self, robot: str) -> EncodedMap:
        """Return the map that ``robot`` is sent behind the acknowledgement of its Ready.

        Of a part :meth:`.Mailboxes.finish` is to be told, so that more can follow. Raises StoreError.
        """
        offer = await self._offer(robot)
        self._unplaced.discard(robot)
        self._parts[robot] = offer.border
        return offer

    def located(self, robots: Iterable[str]) -> None:
        """Note that ``robots`` have said where they are."""
        for robot in self._unplaced.intersection(robots):
            self._unplaced.discard(robot)
            self._mailboxes.parts.put_nowait(robot)

    async def send(self, robot: str) -> None:
        """Send ``robot`` the map of the whole site, or of what is around it; raises StoreError."""
        content = await asyncio.to_thread(self._site.whole_map)
        if content is None:
            await self._store(robot, SetMap((await self._offer(robot)).content))
        else:
            await self._store_whole(robot, content)

    async def whole_or_around(self, robot: str) -> bytes:
        """Return the map of the whole site, or of what is around ``robot``; raises StoreError."""
        # While it is made anew all robots may wait for it, but in one thread: others have work for the rest.
        async with self._making:
            content = await asyncio.to_thread(self._site.whole_map)
        return (await self._offer(robot)).content if content is None else content

    async def send_all(self) -> None:
        """Send all robots their map, one by one; those that are offline get it with their next Ready."""
        for name in self._robots.names():
            robot = self._robots.get(name)
            if robot.state is not RobotState.OFFLINE and robot.can("map"):
                await self.send(name)

    async def run(self) -> None:
        """Send what follows the parts that robots were sent, until cancelled."""
        await asyncio.to_thread(self._site.whole_map)
        while True:
            robot = await self._mailboxes.parts.get()
            try:
                await self._follow(robot)
            except StoreError as error:
                log.error("the map for robot %r: %s; trying again in %g s", robot, error, RETRY_AFTER)
                self._mailboxes.parts.put_nowait(robot)
                await asyncio.sleep(RETRY_AFTER)
            except Exception:
                # The maps of all other robots go out; again and again it would end the gateway.
                note_unforeseen(log, f"the map for robot {robot!r}")

    async def _follow(self, robot: str) -> None:
        content = await asyncio.to_thread(self._site.whole_map)
        if robot not in self._robots:
            return
        known = self._robots.get(robot)
        if content is not None:
            await self._store_whole(robot, content)
        elif known.pose is None or not known.located:
            self._unplaced.add(robot)
        elif not self._parts[robot].holds(known.pose.x, known.pose.y):
            await self.send(robot)

    async def _offer(self, robot: str) -> EncodedMap:
        place = await self._place(robot)
        return await asyncio.to_thread(self._site.map_at_once, place)

    async def _place(self, robot: str) -> Place | None:
        """Return where the robot was last, else where it was told that it stands."""
        pose = self._robots.get(robot).pose if robot in self._robots else None
        if pose is not None:
            return pose.x, pose.y
        given = await self._database.read(tracks.last_given, robot, ("SetPosIni",))
        if given is None:
            return None
        x, y = given.params.get("x"), given.params.get("y")
        return (float(x), float(y)) if isinstance(x, (int, float)) and isinstance(y, (int, float)) else None

    async def _store_whole(self, robot: str, content: bytes) -> None:
        reads_itself = self._robots.get(robot).link == "sql"
        await self._store(robot, SetMap(content) if reads_itself else WHOLE_SITE)

    async def _store(self, robot: str, message: SetMap) -> None:
        await self._mailboxes.finish([Outcome(robot, answer=message)], [], acks=False)
