"""What the map shows, how often, and where files go, as fields."""

from __future__ import annotations

from qgis.gui import QgsFileWidget
from qgis.PyQt.QtWidgets import QComboBox, QDoubleSpinBox, QFormLayout, QLabel, QWidget

from ...file_dialogs import file_field
from ...language import tr
from ...settings.preferences import RANGES, Preferences

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
