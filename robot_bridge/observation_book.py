"""What robots saw: stored before it is acknowledged, reviewed by operators, and then on the map."""

from __future__ import annotations

import asyncio
import hashlib
import json
import logging
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from .errors import RefusedError, UncertainError
from .images import check_size, media_type_of
from .messages import (
    GetObservations,
    MessageError,
    ObservationReport,
    ObservationState,
    Observed,
    ReviewObservation,
    SendImage,
    SetObject,
    to_json,
)
from .monitoring.unforeseen import going_on
from .places import Ground, check_places
from .robots import Robot
from .sites.settings import SiteSettings
from .store import observations
from .store.database import Database
from .store.observations import NewObservation

log = logging.getLogger(__name__)

PENDING, ACCEPTED, REJECTED = ObservationState


class ObservedSite(Ground, Protocol):
    """What is needed of a site to keep observations of it."""

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on; oldest first."""


class ObservationBook:
    """Every observation of the robots of one site.

    ``changed`` is called with each new and each reviewed one, after it was stored.
    """

    def __init__(
        self,
        site: ObservedSite,
        database: Database,
        clock: Callable[[], float],
        changed: Callable[[ObservationReport], None],
    ) -> None:
        self._site = site
        self._database = database
        self._clock = clock
        self._changed = changed
        self._lock = asyncio.Lock()
        self._undrawn = False
        """whether something may have been accepted, or rejected, that the maps do not show yet."""
        self._unsure: set[tuple[str, str]] = set()
        """robots and sources of what may have been stored, and ``changed`` was not called."""
        self._untold: set[int] = set()
        """what may have been reviewed, and ``changed`` was not called."""

    async def restore(self) -> None:
        """Draw on the maps what operators accepted before."""
        self._site.show(await self._database.run(observations.on_map))
        self._undrawn = False

    async def catch_up(self) -> None:
        """Draw and tell what could not be drawn or told when it was stored or reviewed; raises StoreError."""
        if self._undrawn:
            async with self._lock:
                await self.restore()
        for robot, source in list(self._unsure):
            found = await self._database.run(observations.find_told, robot, source)
            self._unsure.discard((robot, source))
            self._tell(found)
        for id in list(self._untold):
            found = await self._database.run(observations.find, id)
            self._untold.discard(id)
            self._tell(found)

    async def add(self, robot: Robot, link: str, told: Observed, id: int | None) -> ObservationReport:
        """Store what a robot told by its message ``id``; what it told before is there already.

        :raises RefusedError: when an object is not on the site, an image too large, or too much waits;
            MessageError when an image is none.
        """
        if isinstance(told, SetObject):
            check_places(self._site, [(told.x, told.y)])
        else:
            self.check_size(len(told.image))
        new = _new(robot.name, told, _occasion(robot, link, told, id), self._clock())
        most_pending = self._site.settings.observations.most_pending
        told_before = new.robot, new.source
        try:
            report, is_new = await self._database.run(observations.add, new, most_pending)
        except UncertainError:
            self._unsure.add(told_before)
            raise
        if is_new or told_before in self._unsure:
            self._tell(report)
        self._unsure.discard(told_before)
        return report

    def check_size(self, size: int) -> None:
        """Raise RefusedError for an image of more bytes than the site takes."""
        check_size(size, self._site.settings.observations.largest_image_bytes)

    async def newest(self, wanted: GetObservations) -> list[ObservationReport]:
        """Return observations, newest first."""
        return await self._database.run(observations.newest, wanted)

    async def image(self, id: int) -> tuple[bytes, str]:
        """Return the image of observation ``id`` and its media type; raises RefusedError without one."""
        found = await self._database.run(observations.image, id)
        if found is None:
            raise RefusedError(f"observation {id} has no image; get_observations lists those with media_type")
        return found

    async def review(self, review: ReviewObservation, operator: str) -> ObservationReport:
        """Accept or reject an observation; returns when that is stored. The same again changes nothing.

        :raises RefusedError: when there is no such observation, or it was reviewed otherwise before.
        """
        async with self._lock:
            report = await self._database.run(observations.find, review.observation)
            if report is None:
                raise RefusedError(f"there is no observation {review.observation}; see get_observations")
            state = ACCEPTED if review.accept else REJECTED
            if _says_the_same(report, review, state):
                return report
            _check_review(report, review)
            values = {name: getattr(review, name) for name in ("semantics", "height", "radius", "reason")}
            is_drawn = report.op == SetObject.__name__
            self._undrawn |= is_drawn
            self._untold.add(report.observation)
            reviewed = await self._database.run(
                observations.review, report.observation, state, operator, self._clock(), values
            )
            if is_drawn and ACCEPTED in (report.state, reviewed.state):
                await self.restore()
        self._tell(reviewed)
        self._untold.discard(reviewed.observation)
        return reviewed

    def _tell(self, report: ObservationReport | None) -> None:
        if report is not None:
            with going_on(log, f"telling of observation {report.observation}"):
                self._changed(report)


def _new(robot: str, told: Observed, occasion: str, now: float) -> NewObservation:
    is_image = isinstance(told, SendImage)
    said = () if is_image else ("label", "height", "radius", "doubts")
    details = {name: getattr(told, name) for name in said}
    return NewObservation(
        robot=robot,
        source=_source(told, occasion),
        kind=type(told).__name__,
        object=told.object,
        x=told.x,
        y=told.y,
        details={name: value for name, value in details.items() if value is not None},
        seen_at=told.t,
        received_at=now,
        image=told.image if isinstance(told, SendImage) else None,
        media_type=media_type_of(told.image, told.media_type) if isinstance(told, SendImage) else None,
    )


def _occasion(robot: Robot, link: str, told: Observed, id: int | None) -> str:
    """Return on what occasion a robot told something: its own source, else the message that it came with."""
    if told.source is None and link == "sql":
        return f"row {id}"
    # The ids of calls, and most sources, begin anew with each run of a robot.
    return f"run {robot.magic}" if told.source is not None else f"run {robot.magic} call {id}"


def _source(told: Observed, occasion: str) -> str:
    """Return what two tellings have in common only if they are one.

    The content counts: a robot that uses a source or a call's id once more for something else loses nothing.
    """
    said: dict[str, Any] = {"op": type(told).__name__, "occasion": occasion, **to_json(told)}
    if told.source is not None:
        said.pop("t", None)
    content = hashlib.sha256(json.dumps(said, sort_keys=True).encode())
    content.update(told.image if isinstance(told, SendImage) else b"")
    return content.hexdigest()


def _says_the_same(report: ObservationReport, review: ReviewObservation, state: ObservationState) -> bool:
    if report.state is not state:
        return False
    said = {name: getattr(review, name) for name in ("semantics", "height", "radius")}
    return all(value is None or value == getattr(report, name) for name, value in said.items())


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
