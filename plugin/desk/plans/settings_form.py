"""The form of what a plan is to be: which cones and stores, what is least, along what."""

from __future__ import annotations

from dataclasses import replace

from qgis.core import QgsProject, QgsVectorLayer
from qgis.gui import QgsCollapsibleGroupBoxBasic
from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QVBoxLayout,
    QWidget,
)

from ...assignment_words import FINISHES, OBJECTIVES
from ...language import tr
from ..cone_store import MARK
from .cone_source import point_layers
from .plan_settings import PlanSettings


class SettingsForm(QWidget):
    """Shows settings, and tells when the operator changed them."""

    changed = pyqtSignal()

    def __init__(self, project: QgsProject, settings: PlanSettings, parent: QWidget | None = None):
        super().__init__(parent)
        self._project = project
        self._settings = settings
        self._quiet = False
        self.cones, self.stores = _combo("fleet_plan_cones"), _combo("fleet_plan_stores")
        self.selected_only = QCheckBox(tr("selected"))
        self.selected_only.setObjectName("fleet_plan_selected_only")
        self.objective = _combo("fleet_plan_objective", OBJECTIVES)
        self.finish = _combo("fleet_plan_finish", FINISHES)
        self.on_roads = QCheckBox(tr("along the roads of the project"))
        self.on_roads.setObjectName("fleet_plan_on_roads")
        self.direct = _spin("fleet_plan_direct", 0.0, 1000.0, " m", 0)
        self.seconds = _spin("fleet_plan_seconds", 0.5, 600.0, " s", 1)
        self.service = _spin("fleet_plan_service", 0.0, 600.0, " s", 1)
        self.clearance = _spin("fleet_plan_clearance", 0.0, 10.0, " m", 2)
        self.apart = _spin("fleet_plan_apart", 0.0, 50.0, " m", 1)
        self._lay_out()
        self._fill_layers()
        self._show()
        for combo in (self.cones, self.stores, self.objective, self.finish):
            combo.currentIndexChanged.connect(self._edited)
        for box in (self.selected_only, self.on_roads):
            box.toggled.connect(self._edited)
        for spin in (self.direct, self.seconds, self.service, self.clearance, self.apart):
            spin.valueChanged.connect(self._edited)
        project.layersAdded.connect(self._fill_layers)
        project.layersRemoved.connect(self._fill_layers)
        project.cleared.connect(self._fill_layers)

    def remove(self) -> None:
        """Listen to the project no longer."""
        self._project.layersAdded.disconnect(self._fill_layers)
        self._project.layersRemoved.disconnect(self._fill_layers)
        self._project.cleared.disconnect(self._fill_layers)

    def settings(self, of: PlanSettings) -> PlanSettings:
        """Return ``of`` with what stands in the form."""
        return replace(
            of,
            cones=self.cones.currentData() or "",
            selected_only=self.selected_only.isChecked(),
            stores=self.stores.currentData() or "",
            objective=self.objective.currentData(),
            finish=self.finish.currentData(),
            seconds=self.seconds.value(),
            service_s=self.service.value(),
            on_roads=self.on_roads.isChecked(),
            direct_m=self.direct.value(),
            clearance_m=self.clearance.value(),
            apart_m=self.apart.value(),
        )

    def show_settings(self, settings: PlanSettings) -> None:
        """Show other settings, as those of a project that was opened."""
        self._settings = settings
        self._fill_layers()
        self._show()

    def _show(self) -> None:
        self._quiet = True
        one = self._settings
        self.selected_only.setChecked(one.selected_only)
        self.objective.setCurrentIndex(self.objective.findData(one.objective))
        self.finish.setCurrentIndex(self.finish.findData(one.finish))
        self.on_roads.setChecked(one.on_roads)
        for spin, value in (
            (self.direct, one.direct_m),
            (self.seconds, one.seconds),
            (self.service, one.service_s),
            (self.clearance, one.clearance_m),
            (self.apart, one.apart_m),
        ):
            spin.setValue(value)
        self._quiet = False

    def _fill_layers(self, *_: object) -> None:
        self._quiet = True
        layers = point_layers(self._project)
        for combo, wanted, none in (
            (self.cones, self.cones.currentData() or self._settings.cones, tr("choose a layer of points")),
            (self.stores, self.stores.currentData() or self._settings.stores, tr("none")),
        ):
            combo.clear()
            combo.addItem(none, "")
            for layer in layers:
                combo.addItem(layer.name(), layer.id())
            combo.setCurrentIndex(max(combo.findData(wanted), 0))
        if self.cones.currentIndex() == 0:
            self.cones.setCurrentIndex(max(self.cones.findData(_placed_by_hand(layers)), 0))
        self._quiet = False
        self._edited()

    def _edited(self, *_: object) -> None:
        self.direct.setEnabled(self.on_roads.isChecked())
        if not self._quiet:
            self.changed.emit()

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(3)
        first = _form()
        first.addRow(tr("Cones"), _row(self.cones, self.selected_only))
        first.addRow(tr("Stores"), self.stores)
        rows.addLayout(first)
        self.more = QgsCollapsibleGroupBoxBasic(tr("How it is planned"))
        self.more.setObjectName("fleet_plan_more")
        self.more.setCollapsed(True)
        second = _form()
        second.addRow(tr("Least"), self.objective)
        second.addRow(tr("At the end"), self.finish)
        second.addRow(self.on_roads)
        second.addRow(tr("Straight within"), self.direct)
        second.addRow(tr("Off cones by"), self.clearance)
        second.addRow(tr("Off robots by"), self.apart)
        second.addRow(tr("A cone takes"), self.service)
        second.addRow(tr("Solve for at most"), self.seconds)
        self.more.setLayout(second)
        rows.addWidget(self.more)
        self.clearance.setToolTip(tr("Ways are led round cones by so much"))
        self.apart.setToolTip(tr("Robots that come nearer to one another by the plan are named"))
        self.selected_only.setToolTip(tr("Only the features of the layer that are selected"))
        self.on_roads.setToolTip(tr("The layers of the project with the role road centreline"))


def _placed_by_hand(layers: list[QgsVectorLayer]) -> str:
    """Return the id of the layer that cone layouts are placed into, nothing without one."""
    return next((layer.id() for layer in layers if layer.customProperty(MARK)), "")


def _combo(name: str, choices: dict[str, str] | None = None) -> QComboBox:
    combo = QComboBox()
    combo.setObjectName(name)
    combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    combo.setMinimumContentsLength(10)
    for value, text in (choices or {}).items():
        combo.addItem(text, value)
    # The name of a layer may be longer than the panel is wide.
    combo.currentTextChanged.connect(combo.setToolTip)
    return combo


def _spin(name: str, least: float, most: float, unit: str, decimals: int) -> QDoubleSpinBox:
    spin = QDoubleSpinBox()
    spin.setObjectName(name)
    spin.setDecimals(decimals)
    spin.setRange(least, most)
    spin.setSuffix(unit)
    return spin


def _form() -> QFormLayout:
    form = QFormLayout()
    form.setContentsMargins(0, 0, 0, 0)
    form.setVerticalSpacing(3)
    return form


def _row(*widgets: QWidget) -> QHBoxLayout:
    row = QHBoxLayout()
    for k, widget in enumerate(widgets):
        row.addWidget(widget, 1 if k == 0 else 0)
    return row
