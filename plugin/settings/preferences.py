"""Preferences of the plugin, and the form on its page of QGIS's options."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path

from qgis.core import QgsSettings
from qgis.gui import QgsFileWidget
from qgis.PyQt.QtCore import QStandardPaths
from qgis.PyQt.QtWidgets import QComboBox, QDoubleSpinBox, QFormLayout, QLabel, QWidget

from ..ui.dialogs import file_field
from ..ui.language import tr

GROUP = "fleet_supervisor/preferences"

RANGES = {"positions_rate": (1.0, 20.0), "layer_seconds": (1.0, 60.0), "robot_size": (0.5, 3.0)}
"""What each number may be."""


@dataclass(frozen=True)
class Preferences:
    """``positions_rate`` is how many times a second positions are asked for at most, from the next connection
    on; ``layer_seconds`` are the seconds between two writes of the layer of robots; ``robot_size`` is how
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


SPINS = (
    ("robot_size", tr("&Size of robots on the map"), " ×", 0.1, 1, tr("1 is as they come")),
    (
        "positions_rate",
        tr("Positions asked for, &times a second"),
        " /s",
        1.0,
        0,
        tr("At most; from the next connection on. Fewer spare a slow network"),
    ),
    (
        "layer_seconds",
        tr("Layer of robots written anew &every"),
        " s",
        1.0,
        0,
        tr("The layer Robots (live): attribute table, labels, expressions. The live map goes its own way"),
    ),
)
DRAWN_BY = {False: tr("the live map: arrows"), True: tr("the layer Robots (live), in its style")}
WIDTH = 90
"""Pixels of a field for a number, so that all are as wide."""


class PreferencesForm(QWidget):
    """A field for each of the preferences."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        form = QFormLayout(self)
        form.setContentsMargins(0, 0, 0, 0)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.ExpandingFieldsGrow)
        self._spins: dict[str, QDoubleSpinBox] = {}
        for name, text, unit, step, decimals, tip in SPINS:
            spin = QDoubleSpinBox()
            spin.setObjectName(f"fleet_{name}")
            spin.setRange(*RANGES[name])
            spin.setSingleStep(step)
            spin.setDecimals(decimals)
            spin.setSuffix(unit)
            spin.setToolTip(tip)
            spin.setMinimumWidth(WIDTH)
            self._spins[name] = spin
            _add(form, text, spin)
        self._drawn_by = QComboBox()
        self._drawn_by.setObjectName("fleet_drawn_by_layer")
        for by_layer, text in DRAWN_BY.items():
            self._drawn_by.addItem(text, by_layer)
        self._drawn_by.setToolTip(
            tr(
                "Arrows show how each robot is, and move with every position. The layer shows what its style "
                "says, as often as it is written anew; while it is not on the map there are arrows"
            )
        )
        _add(form, tr("Robots are &drawn by"), self._drawn_by)
        self._folder = file_field()
        self._folder.setObjectName("fleet_folder")
        self._folder.setStorageMode(QgsFileWidget.StorageMode.GetDirectory)
        self._folder.lineEdit().setPlaceholderText(tr("your documents"))
        _add(form, tr("&Folder for files that are written"), self._folder)

    def show_preferences(self, preferences: Preferences) -> None:
        """Show these values."""
        for name, spin in self._spins.items():
            spin.setValue(getattr(preferences, name))
        self._drawn_by.setCurrentIndex(self._drawn_by.findData(preferences.drawn_by_layer))
        self._folder.setFilePath(preferences.folder)

    def preferences(self) -> Preferences:
        """Return what stands in the fields."""
        numbers = {name: spin.value() for name, spin in self._spins.items()}
        return Preferences(
            **numbers,
            drawn_by_layer=self._drawn_by.currentData(),
            folder=self._folder.filePath().strip(),
        )


def _add(form: QFormLayout, text: str, field: QWidget) -> None:
    label = QLabel(text)
    label.setBuddy(field)
    form.addRow(label, field)
