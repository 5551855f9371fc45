"""Form and dialog of alarm thresholds."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from ...ui.language import tr
from ...ui.steady_widgets import ElidedText
from .board import ALARM_KINDS
from .rules import RANGES, AlarmKind, Thresholds


@dataclass(frozen=True)
class Field:
    """One number of the settings: how it is shown."""

    kind: AlarmKind
    name: str
    label: str
    unit: str
    scale: float = 1.0
    decimals: int = 1


FIELDS = (
    Field(AlarmKind.LOW_BATTERY, "low_battery", tr("begins below"), " %", 100.0, 0),
    Field(AlarmKind.LOW_BATTERY, "battery_margin", tr("ends so much above that"), " %", 100.0, 0),
    Field(AlarmKind.UNSURE, "unsure", tr("begins when less exact than"), " m"),
    Field(AlarmKind.UNSURE, "unsure_margin", tr("ends so much below that"), " m"),
    Field(AlarmKind.TOO_CLOSE, "too_close", tr("begins when two are nearer than"), " m"),
    Field(AlarmKind.TOO_CLOSE, "close_margin", tr("ends so much further apart"), " m"),
    Field(AlarmKind.WILL_PASS, "pass_within", tr("begins so long before"), " s", 1.0, 0),
    Field(AlarmKind.OUTSIDE_SITE, "outside_margin", tr("begins so far outside"), " m"),
    Field(AlarmKind.OFF_ROAD, "road_margin", tr("begins so far beside the road"), " m"),
    Field(AlarmKind.STOPPED, "stopped_after", tr("begins after standing with a task for"), " s", 1.0, 0),
)
SITE_SETS = tr("the site's settings say after how long (see the robots' state)")
GATEWAY_JUDGES = tr("the gateway judges it by the published site, and says what it does")


class ThresholdsForm(QWidget):
    """A box for each kind of alarm that is watched for, with its numbers beside it."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._boxes: dict[AlarmKind, QCheckBox] = {}
        self._numbers: dict[str, QDoubleSpinBox] = {}
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        # All of it fits QGIS's options on a small screen with large type.
        grid.setVerticalSpacing(2)
        for kind in AlarmKind:
            self._add(grid, kind)

    def show_limits(self, limits: Thresholds) -> None:
        """Show these settings."""
        for kind, box in self._boxes.items():
            box.setChecked(kind in limits.kinds)
        for field in FIELDS:
            self._numbers[field.name].setValue(getattr(limits, field.name) * field.scale)

    def limits(self) -> Thresholds:
        """Return what stands in the fields."""
        return Thresholds(
            **{field.name: self._numbers[field.name].value() / field.scale for field in FIELDS},
            kinds=frozenset(kind for kind, box in self._boxes.items() if box.isChecked()),
        )

    def _add(self, grid: QGridLayout, kind: AlarmKind) -> None:
        row = grid.rowCount()
        box = QCheckBox(ALARM_KINDS[kind][0].upper() + ALARM_KINDS[kind][1:])
        box.setObjectName(f"fleet_watch_{kind.name.lower()}")
        self._boxes[kind] = box
        grid.addWidget(box, row, 0)
        fields = [field for field in FIELDS if field.kind is kind]
        if not fields:
            told = ElidedText("", SITE_SETS if kind is AlarmKind.LOST else GATEWAY_JUDGES)
            grid.addWidget(told, row, 1, 1, 2)
        for number, field in enumerate(fields):
            grid.addWidget(QLabel(field.label), row + number, 1)
            grid.addWidget(self._spin_box(field, box), row + number, 2)

    def _spin_box(self, field: Field, box: QCheckBox) -> QDoubleSpinBox:
        least, most = RANGES[field.name]
        spin = QDoubleSpinBox()
        spin.setObjectName(f"fleet_{field.name}")
        spin.setDecimals(field.decimals)
        spin.setRange(least * field.scale, most * field.scale)
        spin.setSuffix(field.unit)
        box.toggled.connect(spin.setEnabled)
        self._numbers[field.name] = spin
        return spin


class ThresholdsDialog(QDialog):
    """The fields, and what to do with them."""

    chosen = pyqtSignal(object)
    """The Thresholds, when OK was pressed."""

    def __init__(self, limits: Thresholds, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_thresholds")
        self.setWindowTitle(tr("Alarm settings"))
        self._form = ThresholdsForm()
        self._buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok
            | QDialogButtonBox.StandardButton.Cancel
            | QDialogButtonBox.StandardButton.RestoreDefaults
        )
        self._buttons.accepted.connect(self._accept)
        self._buttons.rejected.connect(self.reject)
        defaults = self._buttons.button(QDialogButtonBox.StandardButton.RestoreDefaults)
        defaults.clicked.connect(lambda: self._form.show_limits(Thresholds()))
        rows = QVBoxLayout(self)
        rows.addWidget(self._form)
        rows.addWidget(self._buttons)
        self._form.show_limits(limits)

    def _accept(self) -> None:
        self.chosen.emit(self._form.limits())
        self.accept()
