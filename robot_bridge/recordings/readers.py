"""Readers of recordings: GPX, GeoPackages of ``robot-bridge trajectories export``, the reader for a file."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from ..core.errors import CrsError
from ..core.sites.frame import crs_of, projections
from . import tracks
from .bags import read_bag
from .csv_table import TableForm, read_csv
from .tracks import Recording, RecordingError, Remarks, Sample, Source, ValueRefusedError, number

# --- Positions from GPX: each track belongs to a robot, its segments are joined ---

DEEPEST = 64
"""levels of elements."""
LONGEST_TEXT = 1000
"""characters of the content of an element that is read."""
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
            self.found.append(_gpx_sample(point, self._robot))
        except ValueRefusedError as error:
            self._remarks.add(f"{self._file}: row {point.row}, trkpt", str(error))


def read_gpx(file: Path, remarks: Remarks) -> Source:
    """Return the points of the tracks in ``file``; unusable points are recorded in ``remarks``.

    A truncated file yields the points before its end.

    :raises RecordingError: while reading, for a file that is no GPX.
    """
    return Source(tracks.WGS84, _gpx_samples(file, remarks))


def _gpx_samples(file: Path, remarks: Remarks) -> Iterator[Sample]:
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


def _gpx_sample(point: _Point, robot: str) -> Sample:
    texts = point.texts
    if not texts.get("time"):
        raise ValueRefusedError("time", "is missing; a track without times cannot be played")
    course = number(texts["course"], "course", _COURSE) if texts.get("course") else tracks.NOTHING
    return Sample(
        point.row,
        robot,
        tracks.seconds_of(texts["time"], "time"),
        number(point.attributes.get("lon", ""), "lon", tracks.LONGITUDE),
        number(point.attributes.get("lat", ""), "lat", tracks.LATITUDE),
        math.remainder(math.radians(90.0 - course), math.tau),
        number(texts["speed"], "speed", tracks.SPEED_BOUNDS) if texts.get("speed") else tracks.NOTHING,
    )


# --- Positions from a GeoPackage of ``robot-bridge trajectories export``, in its own CRS ---

LAYER = "positions"
FIELDS = ("robot", "time", "heading", "v")
PAGE = 20_000
"""positions read at once."""
_POINT = np.dtype([("order", "u1"), ("kind", "<u4"), ("x", "<f8"), ("y", "<f8")])


def read_geopackage(file: Path, remarks: Remarks) -> Source:
    """Return the positions in layer ``positions``; unusable ones are recorded in ``remarks``.

    :raises RecordingError: for a file that is not such a GeoPackage.
    """
    projections()  # before pyogrio imports pyproj aloud
    import pyogrio

    try:
        found = pyogrio.read_info(str(file), layer=LAYER)
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise RecordingError(
            f"{file} holds no layer {LAYER}, as 'robot-bridge trajectories export' writes it: {error}"
        ) from None
    missing = [name for name in FIELDS if name not in found["fields"]]
    if missing:
        raise RecordingError(f"{file}: layer {LAYER} has no column {missing[0]}")
    return Source(_crs(file, found["crs"]), _geopackage_samples(file, remarks))


def _crs(file: Path, crs: str | None) -> str:
    try:
        if crs is not None and not crs_of(crs).is_geographic:
            return crs
    except CrsError as error:
        raise RecordingError(f"{file}: layer {LAYER}: {error}") from None
    raise RecordingError(f"{file}: layer {LAYER} has the CRS {crs}; one in metres is needed")


def _geopackage_samples(file: Path, remarks: Remarks) -> Iterator[Sample]:
    import pyogrio

    first = 0
    while True:
        try:
            _, fids, points, columns = pyogrio.raw.read(
                str(file),
                layer=LAYER,
                columns=list(FIELDS),
                skip_features=first,
                max_features=PAGE,
                return_fids=True,
            )
        except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError, ValueError) as error:
            remarks.add(f"{file}: behind row {first}", f"nothing can be read any more: {error}")
            return
        for row in zip(fids.tolist(), points, *columns, strict=True):
            try:
                yield _geopackage_sample(*row)
            except ValueRefusedError as error:
                remarks.add(f"{file}: row {row[0]}", str(error))
        if len(fids) < PAGE:
            return
        first += PAGE


def _geopackage_sample(fid: int, point: bytes | None, robot: Any, time: Any, heading: Any, v: Any) -> Sample:
    if point is None or len(point) < _POINT.itemsize or point[0] != 1:
        raise ValueRefusedError("geom", "there is no point")
    place = np.frombuffer(point, dtype=_POINT, count=1)[0]
    if not isinstance(robot, str) or not robot:
        raise ValueRefusedError("robot", "there is no name")
    bounds, _ = tracks.place_bounds(is_earth=False)
    return Sample(
        fid,
        robot,
        _seconds(time),
        _finite(place["x"], "geom x", bounds),
        _finite(place["y"], "geom y", bounds),
        math.remainder(math.radians(90.0 - _finite(heading, "heading", (-360.0, 360.0))), math.tau),
        _finite(v, "v", tracks.SPEED_BOUNDS),
    )


def _seconds(time: Any) -> float:
    at = np.datetime64(time, "ms").astype(np.int64).item() / 1000.0
    if not -tracks.LATEST <= at <= tracks.LATEST:
        raise ValueRefusedError("time", f"{time} is no time")
    return at


def _finite(value: Any, column: str, bounds: tuple[float, float]) -> float:
    number = float(value)
    if not bounds[0] <= number <= bounds[1]:
        raise ValueRefusedError(column, f"{number} is not a number from {bounds[0]:g} to {bounds[1]:g}")
    return number


# --- Choice of the reader for a file ---


@dataclass(frozen=True)
class ReadingOptions:
    """Options of reading a file; ``table`` concerns CSV, ``topics`` bags."""

    table: TableForm = field(default_factory=lambda: TableForm({}))
    topics: Sequence[str] = ()


def read_recording(file: Path, options: ReadingOptions) -> Recording:
    """Return the recording in ``file``; unusable parts are listed in its remarks.

    :raises RecordingError: naming the file, if it holds no recording.
    """
    remarks = Remarks()
    kind = file.name.lower().removesuffix(".gz").rpartition(".")[2]
    if file.is_dir():
        return tracks.gather(file, read_bag(file, options.topics, remarks), remarks)
    if kind not in READERS:
        known = ", ".join(f".{name}" for name in READERS)
        raise RecordingError(f"{file} is of no kind that is read; known are {known}")
    return tracks.gather(file, READERS[kind](file, options, remarks), remarks)


def _csv(file: Path, options: ReadingOptions, remarks: Remarks) -> Source:
    return read_csv(file, options.table, remarks)


def _gpx(file: Path, options: ReadingOptions, remarks: Remarks) -> Source:
    return read_gpx(file, remarks)


def _gpkg(file: Path, options: ReadingOptions, remarks: Remarks) -> Source:
    return read_geopackage(file, remarks)


def _bag(file: Path, options: ReadingOptions, remarks: Remarks) -> Source:
    return read_bag(file, options.topics, remarks)


READERS: Mapping[str, Callable[[Path, ReadingOptions, Remarks], Source]] = {
    "csv": _csv,
    "gpx": _gpx,
    "gpkg": _gpkg,
    "mcap": _bag,
    "db3": _bag,
    "bag": _bag,
}
"""Readers by file name suffix."""
