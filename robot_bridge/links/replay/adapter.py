"""Adapter of recordings: settings, clock, player; recorded drives as robots that take no commands."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
import re
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import ClassVar

import msgspec

from ...core.messages.base import SPEED, MessageError, check_robot_name
from ...core.messages.links import Playback, PlaybackReport
from ...core.messages.robots import SendPos
from ...core.sites.frame import SiteFrame
from ...recordings.csv_table import TableForm
from ...recordings.readers import ReadingOptions, read_recording
from ...recordings.tracks import ORIGINS, Recording, RecordingError, Track
from ..base.adapter import Adapter, Command, Link
from ..base.errors import CommandRefusedError, LinkError
from ..base.frames import FrameSettings, LinkFrame
from ..base.settings import LinkSettings, read_settings

# --- Table ``[replay]`` of a link's settings: which file is played, and how ---

PREFIX = "replay-"
"""Prefix of the names of all replayed robots, also where only names are stored."""
_SLOWEST, _FASTEST = 0.1, 1000.0
_UNUSABLE = re.compile(r"[^A-Za-z0-9_.-]+")


class ReplaySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``file`` is beside the settings; ``robots`` gives recorded robots other names.

    ``speed``, ``start_s`` (seconds after the beginning), ``loop`` and ``paused`` may be changed during
    playback. A robot without records in the file for ``largest_gap_s`` of its seconds is silent. ``columns``,
    ``delimiter``, ``time_unit`` and ``theta_unit`` are those of CSV; ``topics`` are patterns of the topics of
    a bag.
    """

    file: str
    speed: float = 1.0
    start_s: float = 0.0
    loop: bool = False
    paused: bool = False
    robots: dict[str, str] = {}
    largest_gap_s: float = 10.0
    columns: dict[str, str] = {}
    delimiter: str = ","
    time_unit: str = "s"
    theta_unit: str = "rad"
    topics: list[str] = []

    def check(self, file: Path) -> None:
        """Raise LinkError, naming file and key, for invalid values."""
        bounds = {"speed": (_SLOWEST, _FASTEST), "start_s": (0.0, 1e9), "largest_gap_s": (0.1, 1e6)}
        for key, (least, most) in bounds.items():
            if not least <= getattr(self, key) <= most:
                raise LinkError(
                    f"{file}: replay.{key} = {getattr(self, key)}: give a number from {least:g} to {most:g}"
                )
        try:
            self.reading.table.check()
        except RecordingError as error:
            raise LinkError(f"{file}: replay.{error}") from None

    @property
    def reading(self) -> ReadingOptions:
        """Options for reading the file."""
        return ReadingOptions(
            TableForm(self.columns, self.delimiter, self.time_unit, self.theta_unit), tuple(self.topics)
        )

    def is_same_recording(self, other: ReplaySettings) -> bool:
        """Return whether ``other`` differs only in settings that may be changed during playback."""
        changed = msgspec.structs.replace(
            other, speed=self.speed, start_s=self.start_s, loop=self.loop, paused=self.paused
        )
        return changed == self

    def names(self, recorded: list[str], file: Path) -> dict[str, str]:
        """Return the names that recorded robots have on the map; raises LinkError."""
        for name in self.robots:
            if name not in recorded:
                there = ", ".join(recorded[:20])
                raise LinkError(f"{file}: replay.robots.{name}: no robot is recorded so; there are {there}")
        names: dict[str, str] = {}
        for name in recorded:
            given = self.robots.get(name, _UNUSABLE.sub("-", name).strip("-"))
            names[name] = given if given.startswith(PREFIX) else PREFIX + given
            try:
                check_robot_name(names[name])
            except MessageError as error:
                raise LinkError(f"{file}: replay.robots.{name}: {error}") from None
        if len(set(names.values())) < len(names):
            raise LinkError(f"{file}: replay.robots: two robots would have one name; give each its own")
        return names


# --- The position in a recording, by a monotonic clock; no I/O ---


class PlayClock:
    """Seconds of a recording, ``speed`` of them for each second of the clock that ``now`` is read from.

    The place is computed from where it was last set, never accumulated, so it does not drift.
    """

    def __init__(self, place: float, speed: float, now: float, *, paused: bool = False) -> None:
        self._place = place
        self._since = now
        self._speed = speed
        self._paused = paused

    @property
    def speed(self) -> float:
        """Seconds of the recording for each second."""
        return self._speed

    @property
    def is_paused(self) -> bool:
        """Whether it is paused."""
        return self._paused

    def place(self, now: float) -> float:
        """Return the recording's time at ``now``."""
        return self._place if self._paused else self._place + (now - self._since) * self._speed

    def when(self, place: float) -> float:
        """Return the clock's time at which ``place`` is reached; infinite while paused."""
        return math.inf if self._paused else self._since + (place - self._place) / self._speed

    def seek(self, place: float, now: float) -> None:
        """Go to ``place``."""
        self._place, self._since = place, now

    def change(self, now: float, *, speed: float, paused: bool) -> None:
        """Continue from the present place with another speed, or pause."""
        self.seek(self.place(now), now)
        self._speed, self._paused = speed, paused


# --- The positions due when the clock is at a place of the recording; no I/O ---


class ReplayPresence(Enum):
    """Presence of a robot at a place of the recording: not yet, now, silent for too long, or ended."""

    BEFORE, HERE, SILENT, OVER = range(4)


@dataclass
class _Cursor:
    track: Track
    at: int = -1
    """the index of the last reported position, -1 for none."""

    def move(self, place: float) -> bool:
        """Move to the last position up to ``place``; return whether it changed."""
        last, self.at = self.at, int(self.track.t.searchsorted(place, side="right")) - 1
        return self.at != last

    def presence(self, place: float, largest_gap: float) -> ReplayPresence:
        """Return the robot's presence in the recording."""
        if self.at < 0:
            return ReplayPresence.BEFORE
        if place - self.track.t[self.at] <= largest_gap:
            return ReplayPresence.HERE
        return ReplayPresence.OVER if self.at == len(self.track.t) - 1 else ReplayPresence.SILENT


@dataclass(frozen=True)
class ReplayedPosition:
    """Position number ``at`` of a track is due; ``is_new`` unless it was reported before."""

    track: Track
    at: int
    presence: ReplayPresence
    is_new: bool


class Player:
    """Plays the tracks of a recording.

    A robot without records for more than ``largest_gap`` seconds of the recording is silent.
    """

    def __init__(self, recording: Recording, largest_gap: float) -> None:
        self._cursors = [_Cursor(track) for track in recording.tracks]
        self._largest_gap = largest_gap
        self.begin, self.end = recording.begin, recording.end

    def advance(self, place: float) -> Iterator[ReplayedPosition]:
        """Yield for each robot where it is at ``place``, seconds of the recording."""
        for cursor in self._cursors:
            is_new = cursor.move(place)
            yield ReplayedPosition(cursor.track, cursor.at, cursor.presence(place, self._largest_gap), is_new)

    def next_place(self) -> float:
        """Return the time of the next record, infinite at the end."""
        following = (float(c.track.t[c.at + 1]) for c in self._cursors if c.at + 1 < len(c.track.t))
        return min(following, default=math.inf)


# --- The adapter of recordings: reports recorded positions by the recording's clock ---

log = logging.getLogger(__name__)

LEAST_STEP = 0.05
"""seconds between checks of due positions: a connection does not send more often."""
LOOK_EVERY = 1.0
"""seconds between signs of life, and between checks of the settings' file."""
ONLY_SEEN = "this is a recording that is played: it can be seen and not commanded"


class ReplayAdapter(Adapter):
    """Robots of a recording, under names that begin with ``replay-``."""

    kind: ClassVar[str] = "replay"

    def __init__(self, recording: Recording, settings: ReplaySettings, file: Path) -> None:
        self._recording, self._settings, self._file = recording, settings, file
        self._names = settings.names([track.robot for track in recording.tracks], file)
        self._player = Player(recording, settings.largest_gap_s)
        self._stamp = _stamp(file)
        self._complaint: str | None = None
        self._frames: tuple[LinkFrame, LinkFrame] | None = None
        self._outside: Counter[str] = Counter()
        self._latest = 0.0
        """largest delay of a position in seconds since the last report."""
        self._has_sought = True
        self._looked_at = 0.0
        self._sent_count = 0
        self._clock: PlayClock | None = None
        self._is_changed = asyncio.Event()

    async def run(self, link: Link) -> None:
        """Play until cancelled; at the end the robots stay until the settings are changed."""
        settings = self._settings
        begin = self._recording.begin + settings.start_s
        clock = PlayClock(begin, settings.speed, time.monotonic(), paused=settings.paused)
        self._clock = clock
        reported_at = -math.inf
        while True:
            now = time.monotonic()
            is_look = now - self._looked_at >= LOOK_EVERY
            if is_look:
                self._check_settings(clock, now)
            if self._settings.loop and clock.place(now) > self._player.end:
                # It restarts at the exact moment of its end, however late this is noticed.
                clock.seek(self._player.begin, clock.when(self._player.end))
            if self._report_positions(link, clock, now, again=is_look):
                reported_at = now
            if is_look:
                self._looked_at = now
                self._report(link, clock, now)
            due = max(clock.when(self._player.next_place()), reported_at + LEAST_STEP)
            await self._wait_until(min(due, self._looked_at + LOOK_EVERY))

    def playback(self, change: Playback) -> PlaybackReport:
        """Change the playback, from here or from another place, until the settings' file is changed."""
        clock, now, settings = self._clock, time.monotonic(), self._settings
        if clock is None:
            raise CommandRefusedError("the recording has not begun")
        given = {"speed": change.speed, "paused": change.paused, "loop": change.loop}
        changed = msgspec.structs.replace(
            settings, **{name: value for name, value in given.items() if value is not None}
        )
        length = self._recording.end - self._recording.begin
        if change.place_s is not None and not 0 <= change.place_s <= length:
            raise CommandRefusedError(f"place_s = {change.place_s:g}: the recording is {length:.1f} s long")
        try:
            changed.check(self._file)
        except LinkError as error:
            raise CommandRefusedError(str(error)) from None
        self._settings = changed
        clock.change(now, speed=changed.speed, paused=changed.paused)
        if change.place_s is not None:
            self._seek(clock, change.place_s, now)
        self._looked_at = 0.0
        self._is_changed.set()
        place = round(min(clock.place(now) - self._recording.begin, length), 3)
        file = self._recording.file.name
        return PlaybackReport(file, changed.speed, changed.paused, changed.loop, place, round(length, 3))

    async def _wait_until(self, due: float) -> None:
        self._is_changed.clear()
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(max(due - time.monotonic(), 0.0)):
                await self._is_changed.wait()

    def _seek(self, clock: PlayClock, place_s: float, now: float) -> None:
        clock.seek(self._recording.begin + place_s, now)
        self._has_sought = True

    async def command(self, command: Command) -> None:
        """Refuse it: the gateway does not send any."""
        raise CommandRefusedError(ONLY_SEEN)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Do nothing: replayed robots cannot be stopped."""

    def _report_positions(self, link: Link, clock: PlayClock, now: float, *, again: bool) -> bool:
        """Report the robots that moved, with ``again`` also that the others are alive.

        Return whether any moved.
        """
        sent_before = self._sent_count
        known = set(link.robots)
        status = self._status(clock)
        for position in self._player.advance(clock.place(now)):
            name = self._names[position.track.robot]
            if position.presence is ReplayPresence.HERE and (position.is_new or (again and clock.is_paused)):
                if name not in known:
                    link.add(name)
                if position.is_new:
                    self._sent_count += 1
                    self._record_delay(now - clock.when(float(position.track.t[position.at])))
                self._place(link, name, position, status, stands=clock.is_paused)
            elif position.presence is ReplayPresence.HERE and again:
                link.alive(name)
            elif position.presence in (ReplayPresence.BEFORE, ReplayPresence.OVER) and name in known:
                link.stopped(name)
                link.remove(name)
        self._has_sought = False
        return self._sent_count > sent_before

    def _record_delay(self, seconds: float) -> None:
        # After a jump the last position before that place is reported, whatever its age.
        if not self._has_sought:
            self._latest = max(self._latest, seconds)

    def _place(self, link: Link, name: str, position: ReplayedPosition, status: str, *, stands: bool) -> None:
        track, at = position.track, position.at
        try:
            place = self._frame(link).pose_to_site(
                float(track.x[at]), float(track.y[at]), float(track.theta[at])
            )
        except ValueError as error:
            self._outside[name] += 1
            if self._outside[name] == 1:
                log.warning("robot %s is left out where it cannot be shown: %s", name, error)
            return
        v = 0.0 if stands else min(max(float(track.v[at]), SPEED[0]), SPEED[1])
        origin = ORIGINS[track.theta_from[at]]
        link.position(name, SendPos(*place, v, status=status, theta_from=origin))

    def _status(self, clock: PlayClock) -> str:
        paused = ", paused" if clock.is_paused else ""
        return f"replay of {self._recording.file.name} ×{clock.speed:g}{paused}"

    def _frame(self, link: Link) -> LinkFrame:
        """Return the frame of the file if it names one, else that of the link's settings."""
        crs, site = self._recording.crs, link.site
        if crs is None:
            return link.frame
        if self._frames is None or self._frames[0] is not link.frame:
            own = LinkFrame(FrameSettings(crs=crs), SiteFrame(site.crs, site.origin, site.rotation))
            self._frames = link.frame, own
        return self._frames[1]

    def _check_settings(self, clock: PlayClock, now: float) -> None:
        stamp = _stamp(self._file)
        if stamp == self._stamp:
            return
        self._stamp = stamp
        try:
            _, new = read_settings(self._file, "replay", ReplaySettings)
            new.check(self._file)
        except LinkError as error:
            self._complain(f"played on as before: {error}")
            return
        if not self._settings.is_same_recording(new):
            self._complain(
                f"{self._file}: only replay.speed, start_s, loop and paused change what is being played; "
                "start the link anew for the rest"
            )
            return
        self._complaint = None
        clock.change(now, speed=new.speed, paused=new.paused)
        if new.start_s != self._settings.start_s:
            self._seek(clock, new.start_s, now)
        self._settings = new

    def _complain(self, text: str) -> None:
        self._complaint = text
        log.error("%s", text)

    def _report(self, link: Link, clock: PlayClock, now: float) -> None:
        recording, place = self._recording, clock.place(now) - self._recording.begin
        length = recording.end - recording.begin
        text = f"{self._status(clock)}, at its end" if place > length else self._status(clock)
        if recording.remarks.count:
            text = f"{text}; {recording.remarks.count} rows left out, the first: {recording.remarks.texts[0]}"
        counts = {
            "told": float(self._sent_count),
            "place_s": round(min(place, length), 1),
            "length_s": round(length, 1),
            "latest_ms": round(1e3 * self._latest, 1),
            "left_out": float(recording.remarks.count),
            "outside": float(self._outside.total()),
        }
        self._latest = 0.0
        link.report(ok=self._complaint is None, text=(self._complaint or text)[:500], counts=counts)


def _stamp(file: Path) -> tuple[int, int] | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size


def load(file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` and the adapter that plays their recording; raises LinkError."""
    settings, own = read_settings(file, "replay", ReplaySettings)
    own.check(file)
    try:
        recording = read_recording(settings.beside(own.file), own.reading)
    except RecordingError as error:
        raise LinkError(f"{file}: replay.file: {error}") from None
    for text in recording.remarks.texts:
        log.warning("%s", text)
    if recording.remarks.count > len(recording.remarks.texts):
        log.warning("%s: %d rows are left out in all", recording.file, recording.remarks.count)
    if own.start_s > recording.end - recording.begin:
        raise LinkError(
            f"{file}: replay.start_s = {own.start_s:g}: the recording is "
            f"{recording.end - recording.begin:.1f} s long"
        )
    return settings, ReplayAdapter(recording, own, file)
