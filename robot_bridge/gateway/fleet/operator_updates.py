"""Updates of operators: snapshots of the fleet, and observations, stored and announced."""

from __future__ import annotations

import asyncio
import base64
import dataclasses
import hashlib
import json
import logging
import math
import time
from collections.abc import Sequence
from operator import attrgetter
from typing import Any, NamedTuple, Protocol

import msgspec
import numpy as np
import numpy.typing as npt

from ...core.clock import Clock
from ...core.errors import RefusedError, UncertainError
from ...core.images import check_size, media_type_of
from ...core.messages.base import MessageError, to_json
from ...core.messages.positions import (
    PLACE_COLUMNS,
    POSITION_ALWAYS,
    POSITION_TEXTS,
    GetPositions,
    PositionForm,
    Positions,
    RobotReport,
)
from ...core.messages.records import (
    GetImage,
    GetObservations,
    Image,
    ObservationReport,
    Observations,
    ObservationState,
    ReviewObservation,
)
from ...core.messages.robots import Observed, SendImage, SetObject
from ...core.position_frame import METHOD, PLACE_VALUE, POSITION_VALUE, packed_frame
from ...core.sites.settings import SiteSettings
from ..model.events import Encoded, EventBus, ObservationChanged, handles
from ..model.robots import Robot, Robots
from ..site.places import Ground, check_places
from ..storage.database import Database
from ..storage.repositories import records
from ..storage.repositories.records import NewObservation

# --- What robots saw: stored before it is acknowledged, reviewed by operators, and then on the map ---

log = logging.getLogger(__name__)

PENDING, ACCEPTED, REJECTED = ObservationState


class ObservedSite(Ground, Protocol):
    """What is needed of a site to keep observations of it."""

    @property
    def settings(self) -> SiteSettings:
        """The settings of the site."""

    def show(self, objects: Sequence[ObservationReport]) -> None:
        """Draw accepted objects, and no others, on the maps from now on; oldest first."""


class ObservationService:
    """Every observation of the robots of one site; ObservationChanged is published after one was stored."""

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
        """whether something may have been accepted, or rejected, that the maps do not show yet."""
        self._unsure: set[tuple[str, str]] = set()
        """robots and sources of what may have been stored, and nobody was told."""
        self._untold: set[int] = set()
        """what may have been reviewed, and nobody was told."""

    async def restore(self) -> None:
        """Draw on the maps what operators accepted before."""
        self._site.show(await self._database.run(records.on_map))
        self._undrawn = False

    async def redraw(self) -> None:
        """Draw on the maps what is accepted by now; raises StoreError."""
        async with self._lock:
            await self.restore()

    async def catch_up(self) -> None:
        """Draw and tell what could not be drawn or told when it was stored or reviewed; raises StoreError."""
        if self._undrawn:
            await self.redraw()
        for robot, source in list(self._unsure):
            found = await self._database.run(records.find_reported, robot, source)
            self._unsure.discard((robot, source))
            self._tell(found)
        for id in list(self._untold):
            found = await self._database.run(records.find, id)
            self._untold.discard(id)
            self._tell(found)

    async def add(self, robot: Robot, link: str, observed: Observed, id: int | None) -> ObservationReport:
        """Store what a robot told by its message ``id``; what it told before is there already.

        :raises RefusedError: when an object is not on the site, an image too large, or too much waits;
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
            self._tell(report)
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
        """Accept or reject an observation; returns when that is stored. The same again changes nothing.

        :raises RefusedError: when there is no such observation, or it was reviewed otherwise before.
        """
        async with self._lock:
            report = await self._database.run(records.find, review.observation)
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
                records.review, report.observation, state, operator, self._clock.time(), values
            )
            if is_drawn and ACCEPTED in (report.state, reviewed.state):
                await self.restore()
        self._tell(reviewed)
        self._untold.discard(reviewed.observation)
        return reviewed

    def _tell(self, report: ObservationReport | None) -> None:
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
    """Return on what occasion a robot told something: its own source, else the message that it came with."""
    if observed.source is None and link == "sql":
        return f"row {id}"
    # The ids of calls, and most sources, begin again with each run of a robot.
    return f"run {robot.magic}" if observed.source is not None else f"run {robot.magic} call {id}"


def _source(observed: Observed, occasion: str) -> str:
    """Return what two tellings have in common only if they are one.

    The content counts: a robot that uses a source or a call's id once more for something else loses nothing.
    """
    identity: dict[str, Any] = {"op": type(observed).__name__, "occasion": occasion, **to_json(observed)}
    if observed.source is not None:
        identity.pop("t", None)
    content = hashlib.sha256(json.dumps(identity, sort_keys=True).encode())
    content.update(observed.image if isinstance(observed, SendImage) else b"")
    return content.hexdigest()


def _says_the_same(report: ObservationReport, review: ReviewObservation, state: ObservationState) -> bool:
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


# --- Robots as the table of numbers that :mod:`.messages.position_columns` describes; no I/O ---

_OF_A_ROBOT = {
    "age": "received_at",
    "pose_age": "pose_at",
    **{name: name for name in ("latency", "link", "command", "paths", "abilities")},
    "stopped": "ended_in_order",
    "state": "state._value_",
}
_OF_A_POSE = {
    **{name: name for name in ("x", "y", "theta", "v", "battery", "accuracy", "altitude")},
    **{name: name for name in ("status", "theta_from")},
    "device_time": "t",
    "fix_time": "fix_t",
}
"""Columns of a report, and where they stand."""
_AGES = {"age", "pose_age"}
"""Columns of seconds since a time, in whole milliseconds."""
_ROBOT, _POSE = attrgetter(*_OF_A_ROBOT.values()), attrgetter(*_OF_A_POSE.values())
_NOWHERE = (None,) * len(_OF_A_POSE)


def position_table(
    robots: Sequence[Robot], now: float
) -> tuple[dict[str, npt.NDArray[np.float64]], list[str]]:
    """Return what is told of ``robots`` at ``now``: (n,) by column, and the words of texts."""
    if not robots:
        return {name: np.empty(0) for name in POSITION_ALWAYS}, []
    facts = zip(*[_ROBOT(robot) for robot in robots], strict=True)
    poses = zip(*[_NOWHERE if robot.pose is None else _POSE(robot.pose) for robot in robots], strict=True)
    by_column = {**dict(zip(_OF_A_ROBOT, facts, strict=True)), **dict(zip(_OF_A_POSE, poses, strict=True))}
    words: dict[str | None, float] = {None: float("nan")}
    columns = {}
    for name, values in by_column.items():
        if values.count(None) == len(values):
            continue
        columns[name] = _places(values, words) if name in POSITION_TEXTS else np.array(values, np.float64)
    for name in columns.keys() & _AGES:
        columns[name] = np.maximum(now - columns[name], 0.0).round(3)
    if "latency" in columns:
        columns["latency"] = np.round(columns["latency"], 4)
    return columns, [word for word in words if word is not None]


def table_frame(
    t: float,
    robots: Sequence[Robot],
    now: float,
    removed: Sequence[str] = (),
    *,
    everything: bool = False,
    form: PositionForm = PositionForm.COLUMNS,
) -> bytes:
    """Return the binary frame that tells of ``robots`` at ``now``, under the gateway's time ``t``.

    With ``everything`` they are all that there are; else ``removed`` are gone since what was told last.
    """
    columns, words = position_table(robots, now)
    names = [robot.name for robot in robots]
    return packed_table(t, names, columns, words, form, removed=list(removed), everything=everything)


def packed_table(
    t: float,
    names: Sequence[str],
    columns: dict[str, npt.NDArray[np.float64]],
    words: Sequence[str],
    form: PositionForm,
    **news: Any,
) -> bytes:
    """Return the binary frame of a table by :func:`position_table`; ``news`` stand in its head besides."""
    value = POSITION_VALUE
    if form is PositionForm.PLACES:
        columns = {name: columns[name] for name in PLACE_COLUMNS if name in columns}
        value = PLACE_VALUE
    params = {"t": t, "robots": names, "columns": list(columns), "words": words, **news}
    text = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": params})
    return packed_frame(text, columns.values(), value)


def _places(texts: Sequence[str | None], words: dict[str | None, float]) -> npt.NDArray[np.float64]:
    """Return the place of each text among ``words``, which grow by those that are new; NaN for None."""
    if texts.count(texts[0]) == len(texts):
        # Nearly all robots are in one state and on one link.
        return np.full(len(texts), words.setdefault(texts[0], len(words) - 1))
    # None is among them as well, so that a new word's place is one less than how many there are.
    return np.array([words.setdefault(text, len(words) - 1) for text in texts], dtype=np.float64)


# --- Positions as operators are sent them: what changed, encoded once for all who ask at the same rate

EVERYTHING = -1
MOST_RATES = 64
"""rates whose last snapshot is kept."""

ReportRow = msgspec.defstruct(
    "ReportRow",
    [
        (f.name, Any) if f.default is not None else (f.name, Any, None)
        for f in dataclasses.fields(RobotReport)
    ],
    omit_defaults=True,
    gc=False,
)
"""A report as it is encoded: what is unknown is left out, and msgspec makes and writes it several times as
fast as a dataclass. Thousands of them are told every second."""


def positions(rows: Sequence[Any], removed: Sequence[str] = (), *, everything: bool) -> dict[str, Any]:
    """Return rows as the parameters of ``positions`` and the result of ``get_positions``.

    With ``everything`` they are all that there are; else ``removed`` are gone since what was told last.
    """
    message: dict[str, Any] = {"t": round(time.time(), 3), "robots": rows}
    if removed:
        message["removed"] = removed
    return {**message, "everything": True} if everything else message


class Snapshot(NamedTuple):
    """A ``positions`` notification as a frame; None where nothing changed up to ``revision``."""

    frame: bytes | None
    revision: int


class Tick(NamedTuple):
    """A moment that all who are told every ``interval`` seconds share."""

    interval: float
    number: int

    @classmethod
    def last(cls, interval: float, now: float) -> Tick:
        """Return the newest tick at ``now``, seconds of :func:`time.monotonic`."""
        return cls(interval, math.floor(now / interval))

    def following(self, now: float) -> Tick:
        """Return the next tick that is still to come; a timer that went off early counts as on time."""
        return Tick(self.interval, max(self.number, math.floor(now / self.interval)) + 1)

    def wait(self, now: float) -> float:
        """Return the seconds until this tick."""
        return max(0.0, self.number * self.interval - now)


class Snapshots:
    """Makes the frames: at each tick what changed since the one before, and everything for who missed that.

    So a hundred operators at one rate cost two encodings a tick and form at most, however slow some of them
    are. ``clock`` is the one by which robots' messages came in.
    """

    def __init__(self, robots: Robots, clock: Clock) -> None:
        self._robots = robots
        self._clock = clock
        self._made: dict[float, tuple[int, dict[tuple[PositionForm, int], Snapshot]]] = {}

    def after(
        self, revision: int, tick: Tick | None = None, form: PositionForm = PositionForm.ROWS
    ) -> Snapshot:
        """Return what changed after ``revision``, an earlier snapshot's or EVERYTHING.

        Who asks for the same ``tick`` is told the same; without one it is what is known now.
        """
        if tick is None:
            return self._make(revision, form)
        number, made = self._made.pop(tick.interval, (tick.number, {}))
        if number != tick.number:
            made = {}
        if (form, revision) not in made:
            made[form, revision] = self._make(revision, form)
        # Clients choose their rates; the one that was asked for longest ago is forgotten.
        self._made[tick.interval] = (tick.number, made)
        if len(self._made) > MOST_RATES:
            del self._made[next(iter(self._made))]
        return made[form, revision]

    @handles(GetPositions)
    async def now(self) -> Encoded[Positions]:
        """Return where every robot is now."""
        return Encoded(positions(self._robots.rows(self._clock.time(), -1, ReportRow), everything=True))

    def _make(self, revision: int, form: PositionForm) -> Snapshot:
        return Snapshot(self._encoded(revision, form), self._robots.revision)

    def _encoded(self, revision: int, form: PositionForm) -> bytes | None:
        now, changed = self._clock.time(), self._robots.changed(revision)
        everything = revision == EVERYTHING
        removed = [] if everything else self._robots.removed(revision)
        if not (changed or removed or everything):
            return None
        if form is not PositionForm.ROWS:
            return table_frame(round(time.time(), 3), changed, now, removed, everything=everything, form=form)
        rows = self._robots.rows(now, revision, ReportRow)
        params = positions(rows, removed, everything=everything)
        return msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": params})
