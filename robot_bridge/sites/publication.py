"""A published site on disk: a folder with ``site.toml`` and ``site.gpkg``, written whole or not at all."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ..roads.surfaces.surface import Surface
from ..robotmap.outlines import Outlines
from .errors import SiteError
from .feature_layers import (
    area_layer,
    areas_of,
    centreline_layer,
    centrelines_of,
    surface_layer,
    surfaces_of,
)
from .features import Area, Centreline
from .geopackage import GEOPACKAGE_FILE, Layer, check_features, read_layers, write_layers
from .layers import CENTRELINES, KEEPOUTS, OBSTACLES, SURFACES
from .obstacle_layer import obstacle_layer, outlines_of
from .settings import (
    SETTINGS_FILE,
    SiteSettings,
    check_settings,
    earlier_settings,
    read_settings,
    settings_text,
)
from .site import Site


def read_site(folder: Path | str) -> Site:
    """Return the site published in ``folder``.

    :raises SiteError: naming what is missing, half there or wrong, where, and what to do.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise SiteError(
            f"{folder} is no folder: a published site is a folder with {SETTINGS_FILE} and {GEOPACKAGE_FILE}"
        )
    settings = read_settings(folder / SETTINGS_FILE)
    file = folder / GEOPACKAGE_FILE
    specs = (OBSTACLES, CENTRELINES, SURFACES, KEEPOUTS)
    obstacles, centrelines, surfaces, keepouts = read_layers(file, specs, settings.crs, settings.stamp)
    return Site(
        settings=settings,
        outlines=outlines_of(obstacles, settings.frame, str(file)),
        centrelines=centrelines_of(centrelines, settings.frame, str(file)),
        surfaces=surfaces_of(surfaces, settings.frame, str(file)),
        keepouts=areas_of(keepouts, settings.frame, str(file)),
    )


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
        _write(folder, settings, layers)
    except OSError as error:
        raise SiteError(
            f"The site cannot be published in {folder}: {error}. Check rights and free space."
        ) from error


def _write(folder: Path, settings: SiteSettings, layers: Sequence[Layer]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    # A folder inside the target, so that both renames stay on one file system.
    partial = Path(tempfile.mkdtemp(prefix=".writing-", dir=folder))
    try:
        write_layers(partial / GEOPACKAGE_FILE, layers, settings.crs, settings.stamp)
        text = settings_text(settings, earlier_settings(folder, settings.id))
        (partial / SETTINGS_FILE).write_text(text, encoding="utf-8")
        (partial / GEOPACKAGE_FILE).replace(folder / GEOPACKAGE_FILE)
        (partial / SETTINGS_FILE).replace(folder / SETTINGS_FILE)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
