"""Requests of robots: answers (maps, paths, surfaces), and observations stored and reviewed."""

from __future__ import annotations

import asyncio
import base64
import hashlib
import json
import logging
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

from ...core.clock import Clock
from ...core.errors import RefusedError, UncertainError
from ...core.images import check_size, media_type_of
from ...core.messages.base import MessageError, to_json
from ...core.messages.commands import CommandState
from ...core.messages.records import (
    GetImage,
    GetObservations,
    Image,
    ObservationReport,
    Observations,
    ObservationState,
    ReviewObservation,
)
from ...core.messages.roads import GetSurface, SetSurface
from ...core.messages.robots import (
    Answer,
    GetMap,
    GetPath,
    GetPosIni,
    Observed,
    Question,
    SendImage,
    SetMap,
    SetObject,
    SetPath,
    SetPosEnd,
    SetPosIni,
)
from ...core.roads.network import Surface
from ...core.sites.settings import SiteSettings
from ...protocol.codec import decode_answer
from ..commands.service import CommandService
from ..model.arrival import Planner, remaining_path
from ..model.events import Encoded, EventBus, ObservationChanged, handles
from ..model.robots import Robot, Robots
from ..site.places import Ground, check_places
from ..storage.database import Database
from ..storage.repositories import commands, records
from ..storage.repositories.records import NewObservation
from ..traffic.robot_paths import RobotPaths

# --- Answers to robots' questions ---
# GetMap, GetPath, GetPosIni and GetPosEnd are of the paper (1, table II), GetSurface is this project's own.


class Maps(Protocol):
    """Source of maps."""

    def is_quick(self, x: float, y: float, area: float) -> bool:
        """Return whether the map of a square of ``area`` is made in a few milliseconds."""

    def map_around(self, x: float, y: float, area: float) -> bytes:
        """Return the map of a square of ``area`` square metres centred on (x, y)."""

    def surfaces_at(self, points: Sequence[tuple[float, float]], crs: str | None) -> list[Surface | None]:
        """Return the road surface at each of ``points``, None where there is none."""


class RobotReply(NamedTuple):
    """An answer, and the note sent with it to the robot."""

    message: SetMap | SetPath | SetPosIni | SetPosEnd | SetSurface
    note: str = ""


class RobotAnswers:
    """Answers questions from the state of the robots, their commands and the site."""

    def __init__(
        self,
        maps: Maps,
        database: Database,
        robots: Robots,
        commands: CommandService,
        planner: Planner,
        ways: RobotPaths,
    ) -> None:
        self._maps = maps
        self._database = database
        self._robots = robots
        self._commands = commands
        self._planner = planner
        self._ways = ways

    async def answer(self, robot: str, question: Question) -> RobotReply:
        """Return the answer to ``question``; raises RefusedError with the reason where there is none."""
        if isinstance(question, GetMap):
            return RobotReply(SetMap(await self._map(question.x, question.y, question.area)))
        if isinstance(question, GetPath):
            return await self._path(robot)
        if isinstance(question, GetSurface):
            return RobotReply(await self._surfaces(question))
        if isinstance(question, GetPosIni):
            return RobotReply(await self._begin(robot))
        return RobotReply(await self._end(robot))

    async def _map(self, *around: float) -> bytes:
        if self._maps.is_quick(*around):
            return self._maps.map_around(*around)
        return await asyncio.to_thread(self._maps.map_around, *around)

    async def _path(self, robot: str) -> RobotReply:
        task = self._commands.task(robot)
        if task is None:
            raise RefusedError(f"GetPath: robot {robot!r} has no task; wait for SetPosEnd or SetPath")
        known = self._robots.get(robot)
        pose = known.pose
        if pose is None or not known.located:
            raise RefusedError(f"GetPath: it is not known where robot {robot!r} is; send SendPos first")
        message, driven = task
        left = await asyncio.to_thread(remaining_path, message, (pose.x, pose.y), driven, self._planner)
        self._ways.note_reported(robot, message, left.message)
        return RobotReply(*left)

    async def _surfaces(self, question: GetSurface) -> SetSurface:
        try:
            found = await asyncio.to_thread(self._maps.surfaces_at, question.points, question.crs)
        except RefusedError as error:
            raise RefusedError(f"GetSurface: {error}") from error
        return SetSurface([None if one is None else one.label for one in found], question.source)

    async def _begin(self, robot: str) -> SetPosIni:
        given = await self._given("GetPosIni", robot, "SetPosIni", "SetPath")
        if isinstance(given, SetPath):
            return SetPosIni(*given.points[0])
        assert isinstance(given, SetPosIni)
        return given

    async def _end(self, robot: str) -> SetPosEnd:
        given = await self._given("GetPosEnd", robot, "SetPosEnd", "SetPath")
        if isinstance(given, SetPath):
            return SetPosEnd(*given.points[-1], given.theta, bool(given.cone), given.collect)
        assert isinstance(given, SetPosEnd)
        return given

    async def _given(self, question: str, robot: str, *ops: str) -> Answer:
        """Return the newest command of kinds ``ops``, unless it was given up."""
        found = await self._database.read(commands.last_given_track, robot, ops)
        if found is None:
            raise RefusedError(
                f"{question}: robot {robot!r} was given no {' or '.join(ops)} yet; wait for one"
            )
        if not (found.state.is_open or found.state is CommandState.REACHED):
            raise RefusedError(
                f"{question}: the last {found.op} of robot {robot!r} is {found.state.value}; "
                "wait for a new one"
            )
        return decode_answer(found.op, found.params)


# --- Observations of robots: stored before the acknowledgement, reviewed by operators, then on the map ---

log = logging.getLogger(__name__)

PENDING, ACCEPTED, REJECTED = ObservationState


class ObservedSite(Ground, Protocol):
    """Required parts of a site for observations of it."""

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps; oldest first."""


class ObservationService:
    """The observations by robots of one site; ObservationChanged is published after one was stored."""

    def __init__(
        self,
        site: ObservedSite,
        database: Database,
        clock: Clock,
        events: EventBus,
    ) -> None:
        self._site = site
        self._database = database
        self._clock = clock
        self._events = events
        self._lock = asyncio.Lock()
        self._undrawn = False
        """whether there may be reviews that the maps do not show yet."""
        self._unsure: set[tuple[str, str]] = set()
        """robots and sources of observations that may have been stored, and were not published."""
        self._unpublished: set[int] = set()
        """ids of observations that may have been reviewed, and were not published."""

    async def restore(self) -> None:
        """Draw the stored accepted observations on the maps."""
        self._site.show(await self._database.run(records.on_map))
        self._undrawn = False

    async def redraw(self) -> None:
        """Draw the observations accepted by now on the maps; raises StoreError."""
        async with self._lock:
            await self.restore()

    async def catch_up(self) -> None:
        """Draw and publish what could not be when it was stored or reviewed; raises StoreError."""
        if self._undrawn:
            await self.redraw()
        for robot, source in list(self._unsure):
            found = await self._database.run(records.find_reported, robot, source)
            self._unsure.discard((robot, source))
            self._publish(found)
        for id in list(self._unpublished):
            found = await self._database.run(records.find, id)
            self._unpublished.discard(id)
            self._publish(found)

    async def add(self, robot: Robot, link: str, observed: Observed, id: int | None) -> ObservationReport:
        """Store an observation by a robot from its message ``id``; a repeated one is stored once.

        :raises RefusedError: when an object is not on the site, an image too large, or too many are pending;
            MessageError when an image is none.
        """
        if isinstance(observed, SetObject):
            check_places(self._site, [(observed.x, observed.y)])
        else:
            self.check_size(len(observed.image))
        new = _new(robot.name, observed, _occasion(robot, link, observed, id), self._clock.time())
        most_pending = self._site.settings.observations.most_pending
        key = new.robot, new.source
        try:
            report, is_new = await self._database.run(records.add_observations, new, most_pending)
        except UncertainError:
            self._unsure.add(key)
            raise
        if is_new or key in self._unsure:
            self._publish(report)
        self._unsure.discard(key)
        return report

    def check_size(self, size: int) -> None:
        """Raise RefusedError for an image of more bytes than the site takes."""
        check_size(size, self._site.settings.observations.largest_image_bytes)

    @handles(GetObservations)
    async def newest(self, query: GetObservations) -> Observations:
        """Return observations, newest first."""
        return Observations(await self._database.run(records.newest_observations, query))

    @handles(GetImage)
    async def image(self, request: GetImage) -> Encoded[Image]:
        """Return the image of an observation and its media type; raises RefusedError without one."""
        found = await self._database.run(records.image, request.observation)
        if found is None:
            raise RefusedError(
                f"observation {request.observation} has no image; get_observations lists those with "
                "media_type"
            )
        image, media_type = found
        return Encoded({"media_type": media_type, "image": base64.b64encode(image).decode("ascii")})

    @handles(ReviewObservation)
    async def review(self, review: ReviewObservation, operator: str) -> ObservationReport:
        """Accept or reject an observation; returns when this is stored. A repetition changes nothing.

        :raises RefusedError: when there is no such observation, or it was reviewed otherwise before.
        """
        async with self._lock:
            report = await self._database.run(records.find, review.observation)
            if report is None:
                raise RefusedError(f"there is no observation {review.observation}; see get_observations")
            state = ACCEPTED if review.accept else REJECTED
            if _is_same_review(report, review, state):
                return report
            _check_review(report, review)
            values = {name: getattr(review, name) for name in ("semantics", "height", "radius", "reason")}
            is_drawn = report.op == SetObject.__name__
            self._undrawn |= is_drawn
            self._unpublished.add(report.observation)
            reviewed = await self._database.run(
                records.review, report.observation, state, operator, self._clock.time(), values
            )
            if is_drawn and ACCEPTED in (report.state, reviewed.state):
                await self.restore()
        self._publish(reviewed)
        self._unpublished.discard(reviewed.observation)
        return reviewed

    def _publish(self, report: ObservationReport | None) -> None:
        if report is not None:
            self._events.publish(ObservationChanged(report))


def _new(robot: str, observed: Observed, occasion: str, now: float) -> NewObservation:
    is_image = isinstance(observed, SendImage)
    fields = () if is_image else ("label", "height", "radius", "doubts")
    details = {name: getattr(observed, name) for name in fields}
    return NewObservation(
        robot=robot,
        source=_source(observed, occasion),
        kind=type(observed).__name__,
        object=observed.object,
        x=observed.x,
        y=observed.y,
        details={name: value for name, value in details.items() if value is not None},
        seen_at=observed.t,
        received_at=now,
        image=observed.image if isinstance(observed, SendImage) else None,
        media_type=media_type_of(observed.image, observed.media_type)
        if isinstance(observed, SendImage)
        else None,
    )


def _occasion(robot: Robot, link: str, observed: Observed, id: int | None) -> str:
    """Return the occasion of an observation: for one with a source the run, else its message."""
    if observed.source is None and link == "sql":
        return f"row {id}"
    # The ids of calls, and most sources, start again with each run of a robot.
    return f"run {robot.magic}" if observed.source is not None else f"run {robot.magic} call {id}"


def _source(observed: Observed, occasion: str) -> str:
    """Return a digest that two messages share only if they are the same observation.

    It includes the content: a robot that reuses a source or a call's id for something else loses nothing.
    """
    identity: dict[str, Any] = {"op": type(observed).__name__, "occasion": occasion, **to_json(observed)}
    if observed.source is not None:
        identity.pop("t", None)
    content = hashlib.sha256(json.dumps(identity, sort_keys=True).encode())
    content.update(observed.image if isinstance(observed, SendImage) else b"")
    return content.hexdigest()


def _is_same_review(report: ObservationReport, review: ReviewObservation, state: ObservationState) -> bool:
    if report.state is not state:
        return False
    values = {name: getattr(review, name) for name in ("semantics", "height", "radius")}
    return all(value is None or value == getattr(report, name) for name, value in values.items())


def _check_review(report: ObservationReport, review: ReviewObservation) -> None:
    if report.state is not PENDING and not review.revise:
        raise RefusedError(
            f"observation {report.observation} was {report.state.value} by {report.reviewed_by} before; "
            "give revise to change that"
        )
    what = "an image" if report.op == SendImage.__name__ else "of what is missing"
    is_drawn = report.op == SetObject.__name__ and report.doubts is None
    if (
        not is_drawn
        and (
            review.semantics,
            review.height,
            review.radius,
        )
        != (None,) * 3
    ):
        raise MessageError(
            f"review_observation: observation {report.observation} is {what}, which is not drawn on the "
            "map; leave out semantics, height and radius"
        )
