"""Files replaced atomically, by one rename from beside their place; layers of GeoPackages."""

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
"""Prefix of the name of a staging folder; a program that was killed leaves it behind."""


def write_state(file: Path, content: bytes, mode: int = 0o666, *, synced: bool = True) -> None:
    """Replace a program's stored state in ``file``; ``mode`` holds the permissions of a new file.

    It is on the disk when this returns, unless ``synced`` is false: for programs that may not wait for a busy
    disk, such as an adapter that stops vehicles from the same loop. The name beside ``file`` is always the
    same, so that the leftover of a killed program is overwritten by the next: there must be one writer at a
    time.

    :raises OSError: ``file`` is as it was.
    """
    write_beside(file, content, mode, synced=synced).replace(file)
    if synced:
        sync_folder(file.parent)


def write_beside(file: Path, content: bytes, mode: int = 0o666, *, synced: bool = True) -> Path:
    """Write what will replace ``file`` as :func:`write_state` does; return its path; raises OSError."""
    beside = place_beside(file)
    with open(beside, "wb", opener=partial(os.open, mode=mode)) as stream:
        stream.write(content)
        if synced:
            stream.flush()
            os.fsync(stream.fileno())
    return beside


def place_beside(file: Path) -> Path:
    """Return the path at which :func:`write_beside` writes what will replace ``file``."""
    return file.with_name(f".{file.name}.new")


def write_state_into(room: Path, file: Path, content: bytes) -> None:
    """Replace ``file`` by ``room``, filled with ``content`` and trailing spaces: for a full disk.

    The old ``file`` becomes the room for the next time, if it is as large.

    :raises OSError: if there is no room, or it is too small; ``file`` is as it was.
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
    sync_folder(file.parent)
    with suppress(OSError):
        if earlier.stat().st_size >= size:
            earlier.replace(room)
        else:
            earlier.unlink()


@contextmanager
def replacement(file: Path) -> Iterator[Path]:
    """Yield a path to write to that becomes ``file`` when the block ends; after an exception nothing is left.

    It has the name of ``file``, in a folder beside it that only this account may enter. Two programs may
    replace one file at a time: the later one wins.

    :raises OSError: ``file`` is as it was.
    """
    with tempfile.TemporaryDirectory(prefix=STAGE, dir=file.parent) as folder:
        made = Path(folder) / file.name
        yield made
        _sync(made)
        made.replace(file)
        sync_folder(file.parent)


class StagedFiles:
    """Files that are written in ``folder`` and moved into ``target``, all or none.

    For use in a ``with`` block. Files not published when it ends are removed, and so is a folder made for
    them. If it ends with an exception, published files are rolled back and the earlier ones restored. Files
    of other names in ``target`` are left alone.
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
        """Make the folder, and ``target`` if it does not exist; raises OSError."""
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
        """Enter ``writer``, which keeps something in :attr:`folder`; it is exited before the folder is
        removed."""
        return self._open.enter_context(writer)

    def publish(self, names: Iterable[str] | None = None, removed: Iterable[str] = ()) -> None:
        """Delete the files ``removed``, then move ``names`` into their place, in this order.

        Without ``names``, all files that were made are moved, in order of their names. Each is on the disk
        before the first is moved.

        :raises OSError: let the block end with it, so that everything is rolled back.
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
        sync_folder(self.target)

    def _keep_earlier(self, name: str) -> None:
        place = self.target / name
        if place.exists():
            # A second name (link) for it: a reader finds a file at every moment.
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
                self._roll_back()
            self._clear()

    def _roll_back(self) -> None:
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
    """Flush the content of ``file`` to the disk; opened for writing, as Windows requires that."""
    with file.open("r+b") as stream:
        os.fsync(stream.fileno())


def sync_folder(folder: Path) -> None:
    """Flush the names in ``folder`` to the disk, too; some systems and file systems cannot, and need not."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# --- A layer of a GeoPackage, written by pyogrio ---

_UTC = 100
"""GDAL's time zone flag for UTC."""


def write_geopackage_layer(
    file: Path,
    name: str,
    kind: str,
    geometry: NDArray[Any],
    columns: Mapping[str, NDArray[Any]],
    crs: str | None,
    metadata: Mapping[str, str] | None = None,
) -> None:
    """Write the layer ``name`` into ``file``, a GeoPackage, which is created if it does not exist.

    ``kind`` is the type of ``geometry``, (n,) well-known binary; ``columns`` are (n,), times in UTC. It is
    version 1.3 of the format, which GDAL 3.6 and older read. To replace the file atomically, write into the
    path of :func:`replacement` or :class:`StagedFiles`.

    :raises OSError: when it cannot be written. :raises ImportError: if pyogrio is not installed.
    """
    import numpy as np
    import pyogrio
    import pyogrio.raw

    times = [column for column, values in columns.items() if values.dtype.kind == "M"]
    try:
        # A site whose place on the earth is unknown has metres without a CRS.
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
                # Not on the dataset: GDAL would write that into an .aux.xml file beside it at each reading.
                layer_metadata=None if metadata is None else dict(metadata),
                gdal_tz_offsets={column: np.full(len(geometry), _UTC) for column in times},
            )
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise OSError(str(error)) from error
