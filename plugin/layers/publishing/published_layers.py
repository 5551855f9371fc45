"""The layers of a published site, as layers of a project: named, styled, and with their roles."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from qgis.core import QgsFillSymbol, QgsLineSymbol, QgsProject, QgsRuleBasedRenderer, QgsVectorLayer

from ....robot_bridge.core.json_decoder import SHORT, DecodingError, decode_json
from ....robot_bridge.core.sites.geopackage import CENTRELINES, GEOPACKAGE_FILE, KEEPOUTS, OBSTACLES, SURFACES
from ....robot_bridge.core.sites.settings import SETTINGS_FILE
from ....robot_bridge.core.sites.settings_tables import value_text
from ...ui.language import tr
from ..errors import PublicationError
from ..live_layers import fleet_group
from ..roles import (
    KEEPOUT,
    OBSTACLE,
    ROAD_CENTRELINE,
    ROAD_SURFACE,
    LayerExpressions,
    LayerSetup,
    keep_setup,
    layers_with_role,
)

PLAIN = "#78808a"
PLAIN_EDGE = "#4b5159"
"""The colours of obstacles: none that warns."""
AGAIN = tr("Publish the site again.")
STYLES = Path(__file__).parents[3] / "resources" / "styles"


@dataclass(frozen=True)
class _Part:
    layer: str
    title: str
    style: str
    setup: LayerSetup


PARTS = (
    _Part(
        KEEPOUTS.name,
        tr("Keepouts"),
        "keepouts.qml",
        LayerSetup(KEEPOUT, LayerExpressions(semantics='"name"')),
    ),
    _Part(
        OBSTACLES.name,
        tr("Obstacles"),
        "",
        LayerSetup(
            OBSTACLE,
            LayerExpressions(
                height='"height_m"', semantics='"semantics"', outdoor='"outdoor"', base='"base_m"'
            ),
        ),
    ),
    _Part(
        CENTRELINES.name,
        tr("Road centrelines"),
        "road_centrelines.qml",
        LayerSetup(ROAD_CENTRELINE, LayerExpressions(semantics='"surface"', width='"width_m"')),
    ),
    _Part(
        SURFACES.name,
        tr("Road surfaces"),
        "road_surfaces.qml",
        LayerSetup(ROAD_SURFACE, LayerExpressions(semantics='"surface"')),
    ),
)
"""From top to bottom."""


@dataclass(frozen=True)
class LoadedSite:
    """What was loaded: the site's name, its layers, and the titles of those whose role others have."""

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
    """Put the layers of the site published in ``folder`` into ``project``, in a group of its name.

    A role that other layers of the project have already is left to those: nothing shall count twice.

    :raises PublicationError: when a part is missing or cannot be read; nothing is loaded then.
    """
    name, opened = _site_name(folder), _open(folder)
    taken = {part.setup.role for part in PARTS if layers_with_role(project, part.setup.role)}
    group = fleet_group(project).addGroup(name)
    for part, layer in opened:
        if part.setup.role not in taken:
            keep_setup(layer, part.setup)
        _dress(layer, part.style)
        project.addMapLayer(layer, False)
        group.addLayer(layer)
    titles = [part.title for part in PARTS if part.setup.role in taken]
    return LoadedSite(name, [layer for _, layer in opened], titles)


def loaded_already(folder: Path, project: QgsProject) -> list[QgsVectorLayer]:
    """Return the layers of ``project`` that are of the site published in ``folder``."""
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


def _dress(layer: QgsVectorLayer, style: str) -> None:
    if style:
        layer.loadNamedStyle(str(STYLES / style))
    else:
        layer.setRenderer(_areas_and_lines())


def _areas_and_lines() -> QgsRuleBasedRenderer:
    """Return what draws a layer that holds both: one symbol would leave out what is not of its kind."""
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
