"""Outputs: features in sinks, files and folders written completely or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsFeatureSink,
    QgsFields,
    QgsGeometry,
    QgsLineString,
    QgsMultiLineString,
    QgsPolygon,
    QgsProcessingFeedback,
)

from ....robot_bridge.core.files import StagedFiles, replacement
from ...ui.errors import FleetError
from ...ui.language import tr

# --- Files written completely or not at all ---


class OutputError(FleetError):
    """The output file cannot be written."""


def check_target(target: Path, what: str) -> None:
    """Raise :class:`OutputError` unless ``what`` can be written to ``target``, as far as known in advance.

    Anything but a regular file, such as a pipe or /dev/null, is refused: it would be replaced by one.
    """
    try:
        hindrance = _hindrance(Path(os.path.realpath(target)))
    except OSError as error:
        hindrance = error.strerror or str(error)
    if hindrance:
        raise _not_written(what, target, hindrance)


def write_whole(target: Path, content: bytes, what: str = tr("The robot map")) -> None:
    """Write ``content`` to ``target`` through a temporary file: the old content stays until the end.

    ``what`` names it in errors. Of a link the file behind it is replaced.

    :raises OutputError: naming the file and the remedy; no partial file is left.
    """
    check_target(target, what)
    file = Path(os.path.realpath(target))
    try:
        with replacement(file) as made:
            made.write_bytes(content)
    except OSError as error:
        raise _not_written(what, target, error.strerror or str(error)) from error


@contextmanager
def replaced_whole(target: Path | None, what: str) -> Iterator[None]:
    """Let the block write the layer file ``target`` completely or not at all: on failure it is restored.

    With None the block writes no file. ``what`` names it in errors about the old file.

    :raises OutputError: naming the file and the remedy.
    """
    file = None if target is None else Path(os.path.realpath(target))
    aside: dict[Path, Path] = {}
    try:
        for part in _parts_of(file):
            if part.exists():
                part.replace(aside.setdefault(part, part.with_name(f".{uuid4().hex}.part")))
    except OSError as error:
        _put_back(aside)
        raise _not_written(what, file, error.strerror or str(error)) from error
    try:
        yield
    except BaseException:
        for part in _parts_of(file):
            part.unlink(missing_ok=True)
        _put_back(aside)
        raise
    for kept in aside.values():
        kept.unlink(missing_ok=True)


def _parts_of(file: Path | None) -> list[Path]:
    """Return the files of which a layer in ``file`` consists, or that are beside it while it is written."""
    if file is None:
        return []
    beside = [Path(f"{file}{ending}") for ending in ("-journal", "-wal", "-shm")]
    if file.suffix.lower() == ".shp":
        beside = [file.with_suffix(suffix) for suffix in (".dbf", ".shx", ".prj", ".cpg")]
    return [file, *beside]


def _put_back(aside: Mapping[Path, Path]) -> None:
    for part, kept in aside.items():
        if kept.exists():
            kept.replace(part)


def _hindrance(file: Path) -> str:
    """Return why ``file`` cannot be written, empty where no obstacle is known."""
    folder = file.parent
    if file.exists() and not file.is_file():
        return tr("it is there and is no file")
    if not folder.is_dir():
        return tr("there is no folder {folder}", folder=folder)
    return (
        "" if os.access(folder, os.W_OK) else tr("the folder {folder} may not be written to", folder=folder)
    )


def _not_written(what: str, target: Path, reason: str) -> OutputError:
    return OutputError(
        tr(
            "{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists, may be "
            "written to, and has space.",
            what=what,
            target=target,
            reason=reason,
        )
    )


# --- A folder of files that appear all together or not at all ---


class WholeFolder:
    """Collects files beside ``target``'s own and moves them there at the end, as ``StagedFiles`` does.

    Must be used in a ``with`` block.

    :raises OutputError: when the folder or a file in it cannot be written.
    """

    def __init__(self, target: Path, what: str):
        """Collect files for the folder ``target``; ``what`` names them in errors."""
        self._what, self._staged = what, StagedFiles(target)

    def __enter__(self) -> WholeFolder:
        with self._refusing():
            self._staged.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        self._staged.__exit__(*error)

    @property
    def folder(self) -> Path:
        """Where files are collected: those that programs write themselves are written there."""
        return self._staged.folder

    def add(self, name: str, content: bytes) -> None:
        """Add ``content`` as the file ``name``."""
        if (self._staged.target / name).is_dir():
            raise OutputError(
                tr(
                    "{path} is a folder, where a file is to be written: choose another OUTPUT.",
                    path=self._staged.target / name,
                )
            )
        with self._refusing():
            (self._staged.folder / name).write_bytes(content)

    def publish(self) -> None:
        """Move every file to its place."""
        with self._refusing():
            self._staged.publish()

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise OutputError(
                tr(
                    "{what} cannot be written to {folder}: {reason}. Choose a folder that may be written to, "
                    "and check the free space.",
                    what=self._what,
                    folder=self._staged.target,
                    reason=error.strerror or error,
                )
            ) from error


# --- Shapes written to the output layers of an algorithm ---

AT_ONCE = 1000
"""Number of features added to a layer together; cancellation is checked between them."""


def polygon(rings: Sequence[np.ndarray]) -> QgsGeometry:
    """Return the polygon of ``rings``, (n, 2) each and closed, the outer one first."""
    area = QgsPolygon(_line(rings[0]))
    for ring in rings[1:]:
        area.addInteriorRing(_line(ring))
    return QgsGeometry(area)


def lines(parts: Iterable[np.ndarray]) -> QgsGeometry:
    """Return one geometry of several lines, (n, 2) each."""
    several = QgsMultiLineString()
    for part in parts:
        several.addGeometry(_line(part))
    return QgsGeometry(several)


def line(points: np.ndarray) -> QgsGeometry:
    """Return the line along ``points``, (n, 2)."""
    return QgsGeometry(_line(points))


def fill_sink(
    sink: QgsFeatureSink,
    fields: QgsFields,
    rows: Sequence[tuple[QgsGeometry, Sequence[Any]]],
    feedback: QgsProcessingFeedback,
) -> bool:
    """Add a feature for each (geometry, values) to ``sink``; return False if cancelled.

    :raises OutputError: when the layer does not accept them.
    """
    for start in range(0, len(rows), AT_ONCE):
        if feedback.isCanceled():
            return False
        features = [_feature(fields, *row) for row in rows[start : start + AT_ONCE]]
        if not sink.addFeatures(features, QgsFeatureSink.Flag.FastInsert):
            raise OutputError(
                tr(
                    "A layer cannot be written ({reason}): choose another place or format for it, and check "
                    "the free space.",
                    reason=sink.lastError() or tr("no reason is given"),
                )
            )
    return True


def _feature(fields: QgsFields, geometry: QgsGeometry, values: Sequence[Any]) -> QgsFeature:
    feature = QgsFeature(fields)
    feature.setGeometry(geometry)
    feature.setAttributes(list(values))
    return feature


def _line(points: np.ndarray) -> QgsLineString:
    return QgsLineString(points[:, 0].tolist(), points[:, 1].tolist())
