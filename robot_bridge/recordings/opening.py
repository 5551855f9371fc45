"""Which reader a file is for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .bags.reading import read_bag
from .columns import TableForm
from .csv_table import read_csv
from .errors import RecordingError
from .geopackage import read_geopackage
from .gpx import read_gpx
from .samples import Remarks, Source
from .tracks import Recording, gather


@dataclass(frozen=True)
class ReadingOptions:
    """How a file is to be read; ``table`` concerns CSV, ``topics`` bags."""

    table: TableForm = field(default_factory=lambda: TableForm({}))
    topics: Sequence[str] = ()


def read_recording(file: Path, options: ReadingOptions) -> Recording:
    """Return the recording in ``file``; what in it cannot be used stands in its remarks.

    :raises RecordingError: naming the file, for what holds no recording.
    """
    remarks = Remarks()
    kind = file.name.lower().removesuffix(".gz").rpartition(".")[2]
    if file.is_dir():
        return gather(file, read_bag(file, options.topics, remarks), remarks)
    if kind not in READERS:
        known = ", ".join(f".{name}" for name in READERS)
        raise RecordingError(f"{file} is of no kind that is read; known are {known}")
    return gather(file, READERS[kind](file, options, remarks), remarks)


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
"""Readers by the ending of a file's name."""
