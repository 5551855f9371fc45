"""Publishes a site from QGIS: a folder with ``site.toml`` and ``site.gpkg``, whole or as it was before."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from qgis.core import QgsFeedback

from ...robot_bridge.sites.errors import SettingsError
from ...robot_bridge.sites.geopackage import GEOPACKAGE_FILE
from ...robot_bridge.sites.mapped.cache import CACHE_FILE
from ...robot_bridge.sites.mapped.writing import CacheWriter
from ...robot_bridge.sites.publication import cache_writer, put_cache, write_site_cache
from ...robot_bridge.sites.settings import (
    SETTINGS_FILE,
    SiteSettings,
    check_values,
    earlier_settings,
    settings_text,
)
from ..language import tr
from .errors import PublicationError
from .publication_lock import unwritable
from .site_content import SiteContent
from .site_file import stamp_in, write_site_file

_ID = re.compile(r"""^[ \t]*id[ \t]*=[ \t]*(?:"([^"\n]*)"|'([^'\n]*)')""", re.MULTILINE)
_VERSION = re.compile(r"^[ \t]*version[ \t]*=[ \t]*(\d+)", re.MULTILINE)
_PARTIAL = ".publishing-"
_STAMP = re.compile(r"(.+) version (\d+)")


@dataclass(frozen=True)
class Earlier:
    """The publication that a folder holds already."""

    id: str
    version: int


def earlier_publication(folder: Path) -> Earlier | None:
    """Return what is published in ``folder``, None when nothing is.

    The two lines wanted of ``site.toml`` are found by their shape, because Python before 3.11 reads no TOML.
    After a publication cut off between its two files the higher version counts, so that it is not used twice.

    :raises PublicationError: when the folder holds files of these names that are no publication.
    """
    settings_file, layers_file = folder / SETTINGS_FILE, folder / GEOPACKAGE_FILE
    found = []
    if settings_file.is_file():
        text = settings_file.read_text(encoding="utf-8", errors="replace")
        name, version = _ID.search(text), _VERSION.search(text)
        if name is None or version is None:
            raise _not_a_publication(settings_file)
        found.append(Earlier(name[1] or name[2] or "", int(version[1])))
    if layers_file.is_file():
        stamp = _STAMP.fullmatch(stamp_in(layers_file))
        if stamp is None and not found:
            raise _not_a_publication(layers_file)
        if stamp is not None and (not found or stamp[1] == found[0].id):
            found.append(Earlier(stamp[1], int(stamp[2])))
    return max(found, key=lambda earlier: earlier.version, default=None)


def next_version(settings: SiteSettings, folder: Path, *, replace_other: bool = False) -> SiteSettings:
    """Return ``settings`` with the version after the one published in ``folder``, 1 for a first one.

    :raises PublicationError: when the folder holds another site and ``replace_other`` is not said.
    """
    try:
        earlier = earlier_publication(folder)
    except PublicationError:
        if not replace_other:
            raise
        earlier = None
    if earlier is not None and earlier.id == settings.id:
        return replace(settings, version=earlier.version + 1)
    if earlier is not None and not replace_other:
        raise PublicationError(
            tr(
                "{folder} holds version {version} of another site, {other}: choose another folder for "
                "{site}, or say that the other site may be replaced (REPLACE=true).",
                folder=folder,
                version=earlier.version,
                other=earlier.id,
                site=settings.id,
            )
        )
    return replace(settings, version=1)


class NewPublication:
    """A publication that is being made in ``partial``, a folder inside ``folder``."""

    def __init__(self, folder: Path, partial: Path) -> None:
        self._folder, self._partial = folder, partial
        self._cache: CacheWriter | None = None

    def write_layers(self, content: SiteContent, settings: SiteSettings, feedback: QgsFeedback) -> bool:
        """Write the layers, in the frame and with the stamp of ``settings``; return false after a cancel.

        :raises PublicationError: when a layer cannot be written.
        """
        self._cache = cache = cache_writer(self._partial, settings.frame)
        return write_site_file(self._partial / GEOPACKAGE_FILE, content, settings, cache, feedback)

    def replace_earlier(self, settings: SiteSettings, feedback: QgsFeedback) -> bool:
        """Put the layers that were written, and ``settings``, in the place of what is published.

        To be called behind :meth:`write_layers`. Return false after a cancel. Other files in the folder stay,
        and in ``site.toml`` the tables that the operator set. A gateway that reads between the replacement of
        the files refuses what it finds and reads no half site.

        :raises PublicationError: when a setting is wrong.
        """
        check_publication_values(settings, self._folder)
        text = settings_text(settings, earlier_settings(self._folder, settings.id))
        (self._partial / SETTINGS_FILE).write_text(text, encoding="utf-8")
        if self._cache is not None:
            write_site_cache(self._partial, settings, text, self._cache)
        if feedback.isCanceled():
            return False
        _replace(self._partial, self._folder)
        return True

    def remove(self) -> None:
        """Delete what was written and not put into the folder."""
        if self._cache is not None:
            self._cache.remove()
        shutil.rmtree(self._partial, ignore_errors=True)


@contextmanager
def new_publication(folder: Path) -> Iterator[NewPublication]:
    """Give a publication to be made in ``folder``; what is not complete at the end leaves nothing there.

    To be called where no other publication is under way, see ``publication_lock``.

    :raises PublicationError: when the folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for left_by_a_crash in folder.glob(f"{_PARTIAL}*"):
            shutil.rmtree(left_by_a_crash, ignore_errors=True)
        # A folder inside the target, so that both renames stay on one file system.
        publication = NewPublication(folder, Path(tempfile.mkdtemp(prefix=_PARTIAL, dir=folder)))
        try:
            yield publication
        finally:
            publication.remove()
    except OSError as error:
        raise unwritable(folder, error.strerror or str(error)) from error


def _replace(partial: Path, folder: Path) -> None:
    """Put the files of ``partial`` in the place of those in ``folder``, or leave these as they were."""
    layers, cache = folder / GEOPACKAGE_FILE, folder / CACHE_FILE
    earlier, earlier_cache = partial / "earlier.gpkg", partial / "earlier.cache"
    if layers.exists():
        shutil.copyfile(layers, earlier)
    if cache.exists():
        # A gateway that looks meanwhile does without.
        cache.replace(earlier_cache)
    try:
        put_cache(partial, folder)
        (partial / GEOPACKAGE_FILE).replace(layers)
        (partial / SETTINGS_FILE).replace(folder / SETTINGS_FILE)
    except OSError:
        _put_back(earlier, layers)
        _put_back(earlier_cache, cache)
        raise


def _put_back(earlier: Path, file: Path) -> None:
    if earlier.exists():
        earlier.replace(file)
    else:
        file.unlink(missing_ok=True)


def check_publication_values(settings: SiteSettings, folder: Path) -> None:
    """Raise :class:`PublicationError` for the first setting that is wrong in itself."""
    try:
        check_values(settings, folder / SETTINGS_FILE)
    except SettingsError as error:
        raise PublicationError(str(error)) from error


def _not_a_publication(file: Path) -> PublicationError:
    return PublicationError(
        tr(
            "{file} is there and is no part of a published site: choose another folder, or say that it may "
            "be replaced (REPLACE=true).",
            file=file,
        )
    )
