"""Publication of a site into its folder, complete or not at all, by one process at a time; and its layers."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

from qgis.core import (
    QgsFeedback,
    QgsFillSymbol,
    QgsLineSymbol,
    QgsProject,
    QgsRuleBasedRenderer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QLockFile

from ....robot_bridge.core.errors import SettingsError
from ....robot_bridge.core.files import StagedFiles
from ....robot_bridge.core.json_decoder import SHORT, DecodingError, decode_json
from ....robot_bridge.core.sites.geopackage import CENTRELINES, GEOPACKAGE_FILE, KEEPOUTS, OBSTACLES, SURFACES
from ....robot_bridge.core.sites.settings import SETTINGS_FILE, SiteSettings, check_values
from ....robot_bridge.core.sites.settings_tables import value_text
from ....robot_bridge.core.sites.site import cache_writer, publish_staged, write_settings_and_cache
from ....robot_bridge.core.sites.site_cache import CacheWriter
from ...ui.errors import PublicationError
from ...ui.language import tr
from .. import roles
from ..live_layers import fleet_group
from .site_content import SiteContent
from .site_file import stamp_in, write_site_file

# --- One publication at a time into a folder, across processes ---

LOCK_FILE = ".publishing.lock"


@contextmanager
def exclusive_publication(folder: Path) -> Iterator[None]:
    """Keep other publications out of ``folder``, which is created if missing, until the block ends.

    The lock of a process that was killed does not block others.

    :raises PublicationError: when another publication is under way, or the folder cannot be written.
    """
    is_new = not folder.exists()
    _check_is_folder(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(folder, error.strerror or str(error)) from error
    lock = QLockFile(str(folder / LOCK_FILE))
    # However long a publication takes: the lock is void only when its process has ended.
    lock.setStaleLockTime(0)
    if not lock.tryLock(0):
        raise _why_not(lock, folder)
    try:
        yield
    finally:
        lock.unlock()
        if is_new:
            with suppress(OSError):
                folder.rmdir()


def unwritable(folder: Path, reason: str) -> PublicationError:
    """Return the error of a ``folder`` that cannot be written for ``reason``."""
    return PublicationError(
        tr(
            "The site cannot be published in {folder}: {reason}. Check the folder's rights and the free "
            "space.",
            folder=folder,
            reason=reason,
        )
    )


def _check_is_folder(folder: Path) -> None:
    in_the_way = next(
        (path for path in (folder, *folder.parents) if path.exists() and not path.is_dir()), None
    )
    if in_the_way is not None:
        raise PublicationError(
            tr(
                "The site cannot be published in {folder}: {file} is a file. Choose a folder: a new one, or "
                "the one that the site was published in before.",
                folder=folder,
                file=in_the_way,
            )
        )


def _why_not(lock: QLockFile, folder: Path) -> PublicationError:
    if lock.error() != QLockFile.LockError.LockFailedError:
        return unwritable(folder, tr("no file {lock_file} can be made in it", lock_file=LOCK_FILE))
    known, process, host, _ = lock.getLockInfo()
    who = tr("process {process} on {host}", process=process, host=host) if known else tr("another process")
    return PublicationError(
        tr(
            "Another publication into {folder} is under way, by {who}: wait until it has ended, or choose "
            "another folder. If it ended on another computer without a word, remove {file}.",
            folder=folder,
            who=who,
            file=folder / LOCK_FILE,
        )
    )


# --- Publication of a site from QGIS: a folder with ``site.toml`` and ``site.gpkg``, complete or unchanged

_ID = re.compile(r"""^[ \t]*id[ \t]*=[ \t]*(?:"([^"\n]*)"|'([^'\n]*)')""", re.MULTILINE)
_VERSION = re.compile(r"^[ \t]*version[ \t]*=[ \t]*(\d+)", re.MULTILINE)
_PARTIAL = ".publishing-"
_STAMP = re.compile(r"(.+) version (\d+)")


@dataclass(frozen=True)
class EarlierPublication:
    """The publication already in a folder."""

    id: str
    version: int


def earlier_publication(folder: Path) -> EarlierPublication | None:
    """Return the publication in ``folder``, None when there is none.

    The two lines needed of ``site.toml`` are found by their pattern, because Python before 3.11 reads no
    TOML. After a publication cut off between its two files the higher version counts, so that it is not used
    twice.

    :raises PublicationError: when the folder has files of these names that are no publication.
    """
    settings_file, layers_file = folder / SETTINGS_FILE, folder / GEOPACKAGE_FILE
    found = []
    if settings_file.is_file():
        text = settings_file.read_text(encoding="utf-8", errors="replace")
        name, version = _ID.search(text), _VERSION.search(text)
        if name is None or version is None:
            raise _not_a_publication(settings_file)
        found.append(EarlierPublication(name[1] or name[2] or "", int(version[1])))
    if layers_file.is_file():
        stamp = _STAMP.fullmatch(stamp_in(layers_file))
        if stamp is None and not found:
            raise _not_a_publication(layers_file)
        if stamp is not None and (not found or stamp[1] == found[0].id):
            found.append(EarlierPublication(stamp[1], int(stamp[2])))
    return max(found, key=lambda earlier: earlier.version, default=None)


def next_version(
    settings: SiteSettings, folder: Path, *, replace_other: bool = False, elsewhere: int = 0
) -> SiteSettings:
    """Return ``settings`` with the version after the one published in ``folder``, 1 for a first one.

    ``elsewhere`` is the version that is published in another place, which must be lower, too.

    :raises PublicationError: when the folder contains another site and ``replace_other`` is false.
    """
    try:
        earlier = earlier_publication(folder)
    except PublicationError:
        if not replace_other:
            raise
        earlier = None
    if earlier is not None and earlier.id == settings.id:
        return replace(settings, version=max(earlier.version, elsewhere) + 1)
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
    return replace(settings, version=elsewhere + 1)


class NewPublication:
    """A publication being made in ``staged``; ``earlier`` is the ``site.toml`` before it."""

    def __init__(self, staged: StagedFiles, earlier: str) -> None:
        self._staged = staged
        self._earlier = earlier
        self._cache: CacheWriter | None = None

    def write_layers(self, content: SiteContent, settings: SiteSettings, feedback: QgsFeedback) -> bool:
        """Write the layers, in the frame and with the stamp of ``settings``; return false if cancelled.

        :raises PublicationError: when a layer cannot be written.
        """
        self._cache = cache = self._staged.enter(cache_writer(self._staged.folder, settings.frame))
        return write_site_file(self._staged.folder / GEOPACKAGE_FILE, content, settings, cache, feedback)

    def write_settings(self, settings: SiteSettings) -> Path:
        """Write ``settings``, after :meth:`write_layers`; return the folder, which is complete now.

        The tables that the operator set in ``site.toml`` are kept.

        :raises PublicationError: when a setting is wrong.
        """
        assert self._cache is not None
        check_publication_values(settings, self._staged.target)
        write_settings_and_cache(self._staged, settings, self._cache, self._earlier)
        return self._staged.folder

    def replace_earlier(self) -> None:
        """Replace the published files by the written ones; other files in the folder stay."""
        publish_staged(self._staged)


@contextmanager
def new_publication(folder: Path, earlier: str) -> Iterator[NewPublication]:
    """Yield a publication to be made in ``folder``; one incomplete at the end leaves nothing there.

    ``earlier`` is the text of the ``site.toml`` before it, empty for none.

    Must be called where no other publication is under way, see :func:`exclusive_publication`.

    :raises PublicationError: when the folder cannot be written.
    """
    try:
        for left_by_a_crash in folder.glob(f"{_PARTIAL}*"):
            shutil.rmtree(left_by_a_crash, ignore_errors=True)
        with StagedFiles(folder, _PARTIAL) as staged:
            yield NewPublication(staged, earlier)
    except OSError as error:
        raise unwritable(folder, error.strerror or str(error)) from error


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


# --- The layers of a published site, in a project ---

PLAIN = "#78808a"
PLAIN_EDGE = "#4b5159"
"""The colours of obstacles: not a warning colour."""
AGAIN = tr("Publish the site again.")
STYLES = Path(__file__).parents[3] / "resources" / "styles"


@dataclass(frozen=True)
class _Part:
    layer: str
    title: str
    style: str
    setup: roles.LayerSetup


PARTS = (
    _Part(
        KEEPOUTS.name,
        tr("Keepouts"),
        "keepouts.qml",
        roles.LayerSetup(roles.KEEPOUT, roles.LayerExpressions(semantics='"name"')),
    ),
    _Part(
        OBSTACLES.name,
        tr("Obstacles"),
        "",
        roles.LayerSetup(
            roles.OBSTACLE,
            roles.LayerExpressions(
                height='"height_m"', semantics='"semantics"', outdoor='"outdoor"', base='"base_m"'
            ),
        ),
    ),
    _Part(
        CENTRELINES.name,
        tr("Road centrelines"),
        "road_centrelines.qml",
        roles.LayerSetup(
            roles.ROAD_CENTRELINE, roles.LayerExpressions(semantics='"surface"', width='"width_m"')
        ),
    ),
    _Part(
        SURFACES.name,
        tr("Road surfaces"),
        "road_surfaces.qml",
        roles.LayerSetup(roles.ROAD_SURFACE, roles.LayerExpressions(semantics='"surface"')),
    ),
)
"""From top to bottom."""


@dataclass(frozen=True)
class LoadedSite:
    """The result of loading: the site's name, its layers, and the titles of those whose role others have."""

    name: str
    layers: list[QgsVectorLayer]
    without_role: list[str]


def site_folder(path: Path) -> Path | None:
    """Return the folder of the published site that ``path`` is, or is a file of; None for anything else."""
    folder = path if path.is_dir() else path.parent
    if path.is_file() and path.name not in (SETTINGS_FILE, GEOPACKAGE_FILE):
        return None
    return folder if (folder / SETTINGS_FILE).is_file() else None


def load_site(folder: Path, project: QgsProject) -> LoadedSite:
    """Add the layers of the site published in ``folder`` to ``project``, in a group of its name.

    A role that other layers of the project have already is left to those: nothing must count twice.

    :raises PublicationError: when a part is missing or cannot be read; nothing is loaded then.
    """
    name, opened = _site_name(folder), _open(folder)
    taken = {part.setup.role for part in PARTS if roles.layers_with_role(project, part.setup.role)}
    group = fleet_group(project).addGroup(name)
    for part, layer in opened:
        if part.setup.role not in taken:
            roles.keep_setup(layer, part.setup)
        _style(layer, part.style)
        project.addMapLayer(layer, False)
        group.addLayer(layer)
    titles = [part.title for part in PARTS if part.setup.role in taken]
    return LoadedSite(name, [layer for _, layer in opened], titles)


def loaded_already(folder: Path, project: QgsProject) -> list[QgsVectorLayer]:
    """Return the layers of ``project`` that belong to the site published in ``folder``."""
    file = str((folder / GEOPACKAGE_FILE).resolve())
    layers = project.mapLayers().values()
    return [layer for layer in layers if str(Path(layer.source().split("|")[0]).resolve()) == file]


def _open(folder: Path) -> list[tuple[_Part, QgsVectorLayer]]:
    file = folder / GEOPACKAGE_FILE
    if not file.is_file():
        raise PublicationError(
            tr(
                "{folder} has a {settings} and no {geopackage}. {again}",
                folder=folder,
                settings=SETTINGS_FILE,
                geopackage=GEOPACKAGE_FILE,
                again=AGAIN,
            )
        )
    opened = [(part, QgsVectorLayer(f"{file}|layername={part.layer}", part.title, "ogr")) for part in PARTS]
    unread = [part.layer for part, layer in opened if not layer.isValid()]
    if unread:
        raise PublicationError(
            tr(
                "{file} has no layer {layers} that can be read. {again}",
                file=file,
                layers=", ".join(unread),
                again=AGAIN,
            )
        )
    return opened


def _style(layer: QgsVectorLayer, style: str) -> None:
    if style:
        layer.loadNamedStyle(str(STYLES / style))
    else:
        layer.setRenderer(_areas_and_lines())


def _areas_and_lines() -> QgsRuleBasedRenderer:
    """Return a renderer for a layer of both areas and lines: a single symbol would leave one of them out."""
    symbols = {
        "Polygon": QgsFillSymbol.createSimple({"color": PLAIN, "outline_color": PLAIN_EDGE}),
        "Line": QgsLineSymbol.createSimple({"color": PLAIN_EDGE, "width": "0.4"}),
    }
    root = QgsRuleBasedRenderer.Rule(None)
    for kind, symbol in symbols.items():
        which = f"geometry_type($geometry) = '{kind}'"
        root.appendChild(QgsRuleBasedRenderer.Rule(symbol, filterExp=which))
    return QgsRuleBasedRenderer(root)


def _site_name(folder: Path) -> str:
    file = folder / SETTINGS_FILE
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise PublicationError(tr("{file} cannot be read: {error}", file=file, error=error)) from error
    for key in ("name", "id"):
        value = value_text(text, "site", key) or ""
        try:
            return str(decode_json(value, SHORT))
        except DecodingError:
            if len(value) > 2:
                return value[1:-1]
    raise PublicationError(
        tr("{file} names no site: it has no table [site] with a name. {again}", file=file, again=AGAIN)
    )
