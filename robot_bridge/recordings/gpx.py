"""Positions out of GPX: each track is a robot's, its segments one after the other."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

from .errors import RecordingError
from .samples import (
    LATITUDE,
    LONGITUDE,
    NOTHING,
    SPEED_BOUNDS,
    WGS84,
    Remarks,
    Sample,
    Source,
    ValueRefusedError,
    number,
)
from .times import seconds_of

DEEPEST = 64
"""levels of elements."""
LONGEST_TEXT = 1000
"""characters of what stands in an element that is read."""
LONGEST_TAG = 1 << 20
"""bytes of a tag, with its attributes, or of a comment."""
CHUNK = 1 << 16
"""bytes parsed at once."""
_READ = ("name", "time", "speed", "course")
_COURSE = (0.0, 360.0)


class _RefusedError(Exception):
    pass


@dataclass
class _Point:
    row: int
    attributes: dict[str, str]
    texts: dict[str, str] = field(default_factory=dict)


class _Parsing:
    """Collects the points of tracks while expat goes through the file."""

    def __init__(self, file: Path, remarks: Remarks) -> None:
        self._file, self._remarks = file, remarks
        self.found: list[Sample] = []
        self.tracks = 0
        self._path: list[str] = []
        self._robot = ""
        self._point: _Point | None = None
        self._text: list[str] | None = None
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype

    def _refuse_doctype(self, *_: Any) -> None:
        raise _RefusedError("it has a document type (DOCTYPE), which no GPX needs; take it out")

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        tag = name.rpartition(" ")[2]
        if not self._path and tag != "gpx":
            raise _RefusedError(f"it is no GPX: its first element is {tag[:40]}")
        if len(self._path) >= DEEPEST:
            raise _RefusedError(f"elements are nested deeper than {DEEPEST} levels")
        self._path.append(tag)
        if tag == "trk":
            self.tracks += 1
            self._robot = f"track-{self.tracks}"
        elif tag == "trkpt":
            self._point = _Point(self.parser.CurrentLineNumber, attributes)
        self._text = [] if tag in _READ else None

    def _characters(self, text: str) -> None:
        if self._text is None:
            return
        if sum(map(len, self._text)) + len(text) > LONGEST_TEXT:
            raise _RefusedError(f"element {self._path[-1]} has more than {LONGEST_TEXT} characters")
        self._text.append(text)

    def _end(self, name: str) -> None:
        tag = self._path.pop()
        text, self._text = self._text, None
        if text is not None and self._point is not None:
            self._point.texts[tag] = "".join(text).strip()
        elif text is not None and tag == "name" and self._path[-1:] == ["trk"]:
            self._robot = "".join(text).strip() or self._robot
        if tag == "trkpt" and self._point is not None:
            self._close(self._point)
            self._point = None

    def _close(self, point: _Point) -> None:
        try:
            self.found.append(_sample(point, self._robot))
        except ValueRefusedError as error:
            self._remarks.add(f"{self._file}: row {point.row}, trkpt", str(error))


def read_gpx(file: Path, remarks: Remarks) -> Source:
    """Return the points of the tracks in ``file``; points that cannot be used are noted in ``remarks``.

    A file that is cut off gives what stands before.

    :raises RecordingError: when it is read, for what is no GPX.
    """
    return Source(WGS84, _samples(file, remarks))


def _samples(file: Path, remarks: Remarks) -> Iterator[Sample]:
    parsing = _Parsing(file, remarks)
    parser = parsing.parser
    try:
        with file.open("rb") as content:
            while chunk := content.read(CHUNK):
                parser.Parse(chunk, False)
                if content.tell() - parser.CurrentByteIndex > LONGEST_TAG:
                    raise _RefusedError(f"a tag has more than {LONGEST_TAG} characters")
                yield from parsing.found
                parsing.found.clear()
            parser.Parse(b"", True)
    except OSError as error:
        raise RecordingError(f"{file} cannot be read: {error.strerror or error}") from None
    except _RefusedError as error:
        raise RecordingError(f"{file}: row {parser.CurrentLineNumber}: {error}") from None
    except expat.ExpatError as error:
        yield from parsing.found
        what = f"what follows cannot be read: {expat.ErrorString(error.code)}"
        if not parsing.tracks:
            raise RecordingError(f"{file}: row {error.lineno}, column {error.offset}: {what}") from None
        remarks.add(f"{file}: row {error.lineno}, column {error.offset}", what)


def _sample(point: _Point, robot: str) -> Sample:
    texts = point.texts
    if not texts.get("time"):
        raise ValueRefusedError("time", "is missing; a track without times cannot be played")
    course = number(texts["course"], "course", _COURSE) if texts.get("course") else NOTHING
    return Sample(
        point.row,
        robot,
        seconds_of(texts["time"], "time"),
        number(point.attributes.get("lon", ""), "lon", LONGITUDE),
        number(point.attributes.get("lat", ""), "lat", LATITUDE),
        math.remainder(math.radians(90.0 - course), math.tau),
        number(texts["speed"], "speed", SPEED_BOUNDS) if texts.get("speed") else NOTHING,
    )
