"""Files written whole or not at all, beside their place and into it by one rename; layers of GeoPackages."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from numpy.typing import NDArray

T = TypeVar("T")
STAGE = ".writing-"
"""What the name of a folder begins with in which files are made; a program that was killed leaves it."""


def write_state(file: Path, content: bytes, mode: int = 0o666, *, synced: bool = True) -> None:
    """Replace what a program keeps in ``file`` for its next start; ``mode`` are the rights of a new one.

    It is on the disk when this returns, unless ``synced`` is false: for programs that may not wait for a
    busy disk, such as an adapter that stops vehicles from the same loop. The name beside ``file`` is always
    the same, so that what a program leaves that is killed on the way is written over by the next: there is
    one writer at a time.

    :raises OSError: ``file`` is as it was.
    """
    beside = file.with_name(f".{file.name}.new")
    with open(beside, "wb", opener=partial(os.open, mode=mode)) as stream:
        stream.write(content)
        if synced:
            stream.flush()
            os.fsync(stream.fileno())
    beside.replace(file)
    if synced:
        _sync_folder(file.parent)


def write_state_into(room: Path, file: Path, content: bytes) -> None:
    """Replace ``file`` by ``room``, with ``content`` and spaces behind it: on a full disk.

    What was ``file`` is the room for the next time, where it is as large.

    :raises OSError: where there is no room, or it is too small; ``file`` is as it was.
    """
    with room.open("r+b") as stream:
        size = os.fstat(stream.fileno()).st_size
        if len(content) > size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        stream.write(content.ljust(size))
        stream.flush()
        os.fsync(stream.fileno())
    earlier = file.with_name(f".{file.name}.earlier")
    with suppress(OSError):
        earlier.unlink(missing_ok=True)
        os.link(file, earlier)
    room.replace(file)
    _sync_folder(file.parent)
    with suppress(OSError):
        if earlier.stat().st_size >= size:
            earlier.replace(room)
        else:
            earlier.unlink()


@contextmanager
def replacement(file: Path) -> Iterator[Path]:
    """Yield where to write what becomes ``file`` when the block ends; after an exception nothing is left.

    It has the name of ``file``, in a folder beside it that only this account may enter. Two programs may
    replace one file at a time: the later one wins.

    :raises OSError: ``file`` is as it was.
    """
    with tempfile.TemporaryDirectory(prefix=STAGE, dir=file.parent) as folder:
        made = Path(folder) / file.name
        yield made
        _sync(made)
        made.replace(file)
        _sync_folder(file.parent)


class StagedFiles:
    """Files that are made in ``folder`` and put into ``target``, all or none.

    To be used in a ``with`` block. What was not published when it ends is removed, and so is a folder that
    was made for it; what was published when it ends by an exception is taken back, and what was there before
    put in its place. Files of other names in ``target`` are left alone.
    """

    def __init__(self, target: Path, prefix: str = STAGE) -> None:
        self.target, self._prefix = target, prefix
        self._stage: Path | None = None
        self._open = ExitStack()
        self._made: list[Path] = []
        self._changed: list[str] = []

    @property
    def folder(self) -> Path:
        """The folder in which the files are made."""
        return self._within("new")

    @property
    def _earlier(self) -> Path:
        return self._within("earlier")

    def _within(self, name: str) -> Path:
        assert self._stage is not None, "only in a with block"
        return self._stage / name

    def __enter__(self) -> StagedFiles:
        """Make the folder, and ``target`` where it is not there; raises OSError."""
        self._made = [path for path in (self.target, *self.target.parents) if not path.exists()]
        try:
            self.target.mkdir(parents=True, exist_ok=True)
            # Inside the target, so that every rename stays on one file system.
            self._stage = Path(tempfile.mkdtemp(prefix=self._prefix, dir=self.target))
            self.folder.mkdir()
            self._earlier.mkdir()
        except OSError:
            self._clear()
            raise
        return self

    def enter(self, writer: AbstractContextManager[T]) -> T:
        """Enter ``writer``, which keeps something in :attr:`folder`; it is left before that is removed."""
        return self._open.enter_context(writer)

    def publish(self, names: Iterable[str] | None = None, removed: Iterable[str] = ()) -> None:
        """Take the files ``removed`` away, then put ``names`` into their place, in this order.

        Without ``names`` all that were made, by their names. Each is on the disk before the first is moved.

        :raises OSError: the block is to end by it, so that all is as it was.
        """
        made = sorted(file.name for file in self.folder.iterdir()) if names is None else list(names)
        for name in made:
            _sync(self.folder / name)
        for name in removed:
            self._keep_earlier(name)
            (self.target / name).unlink(missing_ok=True)
        for name in made:
            self._keep_earlier(name)
            (self.folder / name).replace(self.target / name)
        _sync_folder(self.target)

    def _keep_earlier(self, name: str) -> None:
        place = self.target / name
        if place.exists():
            # A second name for it: there is no moment at which a reader finds no file.
            try:
                os.link(place, self._earlier / name)
            except OSError:
                shutil.copyfile(place, self._earlier / name)
        self._changed.append(name)

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        failed = True
        try:
            self._open.close()
            failed = kind is not None
        finally:
            if failed:
                self._take_back()
            self._clear()

    def _take_back(self) -> None:
        for name in self._changed:
            earlier, place = self._earlier / name, self.target / name
            with suppress(OSError):
                if earlier.exists():
                    earlier.replace(place)
                else:
                    place.unlink(missing_ok=True)
        self._changed = []

    def _clear(self) -> None:
        if self._stage is not None:
            shutil.rmtree(self._stage, ignore_errors=True)
        if self._changed:
            return
        for folder in self._made:
            with suppress(OSError):
                folder.rmdir()


def _sync(file: Path) -> None:
    """Have the content of ``file`` on the disk; for writing, as Windows asks for that."""
    with file.open("r+b") as stream:
        os.fsync(stream.fileno())


def _sync_folder(folder: Path) -> None:
    """Have the names in ``folder`` on the disk, too; some systems and file systems cannot, and need not."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# --- A layer of a GeoPackage, written by pyogrio ---

_UTC = 100
"""How GDAL says that a time is in UTC."""


def write_geopackage_layer(
    file: Path,
    name: str,
    kind: str,
    geometry: NDArray[Any],
    columns: Mapping[str, NDArray[Any]],
    crs: str | None,
    metadata: Mapping[str, str] | None = None,
) -> None:
    """Write the layer ``name`` into ``file``, a GeoPackage, which is made where it is not there yet.

    ``kind`` is the type of ``geometry``, (n,) well-known binary; ``columns`` are (n,), times in UTC. It is
    version 1.3 of the format, which GDAL 3.6 and older read. Whoever wants the file whole or not at all
    writes into what :func:`replacement` or :class:`StagedFiles` give.

    :raises OSError: when it cannot be written. :raises ImportError: where pyogrio is not installed.
    """
    import numpy as np
    import pyogrio
    import pyogrio.raw

    times = [column for column, values in columns.items() if values.dtype.kind == "M"]
    try:
        # Metres of a site whose place nobody knows have no CRS.
        with warnings.catch_warnings(action="ignore") if crs is None else nullcontext():
            pyogrio.raw.write(
                str(file),
                geometry=geometry,
                field_data=list(columns.values()),
                fields=list(columns),
                layer=name,
                driver="GPKG",
                geometry_type=kind,
                crs=crs,
                append=file.exists(),
                dataset_options={"VERSION": "1.3"},
                # Not on the dataset: GDAL writes that into an .aux.xml file beside it on every reading.
                layer_metadata=None if metadata is None else dict(metadata),
                gdal_tz_offsets={column: np.full(len(geometry), _UTC) for column in times},
            )
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise OSError(str(error)) from error
