"""What the operator set on the plugin's page of QGIS's options."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

from qgis.core import QgsSettings
from qgis.PyQt.QtCore import QStandardPaths

GROUP = "fleet_supervisor/preferences"

RANGES = {"positions_rate": (1.0, 20.0), "layer_seconds": (1.0, 60.0), "robot_size": (0.5, 3.0)}
"""What each number may be."""


@dataclass(frozen=True)
class Preferences:
    """``positions_rate`` is how many times a second positions are asked for at most, from the next connection
    on; ``layer_seconds`` is after how many seconds the layer of robots is written anew; ``robot_size`` is how
    large robots are drawn, 1 as they come; ``drawn_by_layer`` is whether the layer of robots draws them, in
    its style, in place of the live map's arrows; ``folder`` is where files are written to unless another is
    chosen, empty for the user's documents.
    """

    positions_rate: float = 10.0
    layer_seconds: float = 1.0
    robot_size: float = 1.0
    drawn_by_layer: bool = False
    folder: str = ""


def read_preferences() -> Preferences:
    """Return what is kept; a number that is none, or out of its range, counts as never set."""
    settings = QgsSettings()
    values: dict[str, object] = {}
    for name, (least, most) in RANGES.items():
        try:
            number = float(str(settings.value(f"{GROUP}/{name}")))
        except ValueError:
            continue
        if least <= number <= most:
            values[name] = number
    return Preferences(
        **values,
        drawn_by_layer=str(settings.value(f"{GROUP}/drawn_by_layer", "")).lower() == "true",
        folder=str(settings.value(f"{GROUP}/folder", "") or ""),
    )


def write_preferences(preferences: Preferences) -> None:
    """Keep every value."""
    for field in fields(preferences):
        QgsSettings().setValue(f"{GROUP}/{field.name}", getattr(preferences, field.name))


def exports_folder() -> str:
    """Return the folder that dialogs for files begin in: the first that is there."""
    documents = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.DocumentsLocation)
    folders = (Path(one) for one in (read_preferences().folder, documents) if one)
    return str(next((folder for folder in folders if folder.is_dir()), Path.home()))


def export_path(name: str) -> str:
    """Return where a file called ``name`` is written to unless the user chooses another place."""
    return str(Path(exports_folder()) / name)
