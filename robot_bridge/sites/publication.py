"""A published site on disk: a folder with ``site.toml`` and ``site.gpkg``, written whole or not at all."""

from __future__ import annotations

import logging
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..roads.surfaces.surface import Surface
from ..robotmap.outlines import Outlines
from .errors import CacheError, SiteError
from .feature_layers import (
    area_layer,
    areas_of,
    centreline_layer,
    centrelines_of,
    surface_layer,
    surfaces_of,
)
from .features import Area, Centreline
from .frame import SiteFrame
from .geopackage import GEOPACKAGE_FILE, Layer, check_features, read_layers, write_layers
from .layers import CENTRELINES, KEEPOUTS, OBSTACLES, SURFACES
from .mapped.cache import CACHE_FILE, SiteCache, read_cache
from .mapped.writing import CacheWriter
from .obstacle_layer import obstacle_layer, outlines_of
from .settings import (
    SETTINGS_FILE,
    SiteSettings,
    check_settings,
    earlier_settings,
    read_settings,
    settings_text,
)
from .settings_toml import value_text
from .site import Site, whole_head

log = logging.getLogger(__name__)

MANY = 50_000
"""Outlines that take seconds to be read from a GeoPackage."""


def check_site(folder: Path | str) -> SiteSettings:
    """Return the settings of the site published in ``folder``, without reading its layers.

    :raises SiteError: naming what is missing or wrong in the settings, where, and what to do.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise SiteError(
            f"{folder} is no folder: a published site is a folder with {SETTINGS_FILE} and {GEOPACKAGE_FILE}"
        )
    return read_settings(folder / SETTINGS_FILE)


def read_site(folder: Path | str) -> Site:
    """Return the site published in ``folder``.

    :raises SiteError: naming what is missing, half there or wrong, where, and what to do.
    """
    folder = Path(folder)
    settings = check_site(folder)
    file = folder / GEOPACKAGE_FILE
    cache = _cache(folder, settings) if file.is_file() else None
    specs = (*(() if cache else (OBSTACLES,)), CENTRELINES, SURFACES, KEEPOUTS)
    *obstacles, centrelines, surfaces, keepouts = read_layers(file, specs, settings.crs, settings.stamp)
    outlines = cache.outlines if cache else outlines_of(obstacles[0], settings.frame, str(file))
    if cache is None and len(outlines) > MANY:
        log.warning(
            "%s: %d outlines are read from %s, which takes its time and memory; publish the site again, and "
            "they are mapped from %s",
            folder,
            len(outlines),
            GEOPACKAGE_FILE,
            CACHE_FILE,
        )
    site = Site(
        settings=settings,
        outlines=outlines,
        centrelines=centrelines_of(centrelines, settings.frame, str(file)),
        surfaces=surfaces_of(surfaces, settings.frame, str(file)),
        keepouts=areas_of(keepouts, settings.frame, str(file)),
        cache=cache,
    )
    # Robots would wait for it.
    site.make_index()
    return site


def write_site_cache(folder: Path, settings: SiteSettings, text: str, obstacles: CacheWriter) -> None:
    """Write ``site.cache`` beside the ``site.gpkg`` in ``folder`` that ``obstacles`` are published in.

    ``text`` is that of ``site.toml``, which says how large a map may be. What a gateway would refuse, or
    read otherwise, has no such file. Raises OSError.
    """
    said = value_text(text, "maps", "largest_whole_bytes") or ""
    most = int(said) if said.isdecimal() else settings.maps.largest_whole_bytes
    publication = _publication(settings)
    obstacles.write(folder / CACHE_FILE, folder / GEOPACKAGE_FILE, publication, whole_head(settings), most)


def cache_writer(partial: Path, frame: SiteFrame) -> CacheWriter:
    """Return what takes the obstacles of a publication that is made in ``partial``; raises OSError.

    It is to be removed, or left as a context manager, before ``partial`` is.
    """
    return CacheWriter(partial / "columns", frame)


def _cache(folder: Path, settings: SiteSettings) -> SiteCache | None:
    file = folder / CACHE_FILE
    if not file.is_file():
        return None
    try:
        return read_cache(file, folder / GEOPACKAGE_FILE, _publication(settings))
    except (CacheError, OSError) as error:
        log.warning("%s; the obstacles are read from %s, which takes longer", error, GEOPACKAGE_FILE)
        return None


def _publication(settings: SiteSettings) -> dict[str, Any]:
    """Return what the columns of ``site.cache`` depend on."""
    return {
        "site": settings.stamp,
        "frame": [settings.crs, *settings.origin, settings.rotation_deg],
        "bounds": list(settings.bounds),
    }


def write_site(
    folder: Path | str,
    settings: SiteSettings,
    obstacles: Outlines,
    centrelines: Sequence[Centreline] = (),
    surfaces: Sequence[Surface] = (),
    keepouts: Sequence[Area] = (),
) -> None:
    """Publish a site in ``folder``: all geometry in the site frame, in metres.

    Other files in ``folder`` stay, and so does in ``site.toml`` what the operator set there, see
    :func:`settings_text`. A publication that is there already is replaced only after the new one
    is complete; one cut off between its two files is refused by :func:`read_site`, never read half.

    :raises SiteError: for what :func:`read_site` would refuse, and when the folder cannot be written.
    """
    folder = Path(folder)
    check_settings(settings, folder / SETTINGS_FILE)
    frame = settings.frame
    layers = (
        obstacle_layer(obstacles, frame),
        centreline_layer(centrelines, frame),
        surface_layer(surfaces, frame),
        area_layer(KEEPOUTS, keepouts, frame),
    )
    for layer in layers:
        check_features(layer, str(folder / GEOPACKAGE_FILE))
    try:
        _write(folder, settings, layers, obstacles)
    except OSError as error:
        raise SiteError(
            f"The site cannot be published in {folder}: {error}. Check rights and free space."
        ) from error


def _write(folder: Path, settings: SiteSettings, layers: Sequence[Layer], obstacles: Outlines) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    # A folder inside the target, so that both renames stay on one file system.
    partial = Path(tempfile.mkdtemp(prefix=".writing-", dir=folder))
    try:
        write_layers(partial / GEOPACKAGE_FILE, layers, settings.crs, settings.stamp)
        text = settings_text(settings, earlier_settings(folder, settings.id))
        (partial / SETTINGS_FILE).write_text(text, encoding="utf-8")
        with cache_writer(partial, settings.frame) as cache:
            cache.add(obstacles)
            write_site_cache(partial, settings, text, cache)
        put_cache(partial, folder)
        (partial / GEOPACKAGE_FILE).replace(folder / GEOPACKAGE_FILE)
        (partial / SETTINGS_FILE).replace(folder / SETTINGS_FILE)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def put_cache(partial: Path, folder: Path) -> None:
    """Put the ``site.cache`` in ``partial`` into ``folder``, or take away the one there; raises OSError.

    Before the files that it belongs to: a gateway does not look at it until they have changed.
    """
    if (partial / CACHE_FILE).is_file():
        (partial / CACHE_FILE).replace(folder / CACHE_FILE)
    else:
        (folder / CACHE_FILE).unlink(missing_ok=True)
