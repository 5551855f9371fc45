"""Forms of a plan's settings: cones, stores, objective, and the table of robots."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

from qgis.core import QgsProject, QgsVectorLayer
from qgis.gui import QgsCollapsibleGroupBoxBasic
from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QHeaderView,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ..cone_texts import FINISHES, OBJECTIVES
from ..control.fleet_controller import FleetController
from ..ui.language import tr
from ..ui.tables import CHECKED, TO_THE_RIGHT, UNCHECKED, number_of
from .layouts.layout_layer import MARK
from .plan_settings import PlanRobotSettings, PlanSettings, available_robots, point_layers

# --- The form of a plan's settings: cones and stores, objective, and roads ---


class SettingsForm(QWidget):
    """Shows settings, and signals when the operator changed them."""

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
        """Stop listening to the project."""
        self._project.layersAdded.disconnect(self._fill_layers)
        self._project.layersRemoved.disconnect(self._fill_layers)
        self._project.cleared.disconnect(self._fill_layers)

    def settings(self, of: PlanSettings) -> PlanSettings:
        """Return ``of`` with the values in the form."""
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
        """Show other settings, like those of a project that was opened."""
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
    """Return the id of the layer into which cone layouts are placed, empty without one."""
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


# --- The robots available for a plan, as an editable table ---

HEADS = (tr("Robot"), tr("Carries"), tr("Aboard"), tr("m/s"), tr("Range"))
_FIELDS = ("used", "capacity", "aboard", "speed", "range_m")
_LEAST = {"capacity": 1, "aboard": 0, "speed": 0.05, "range_m": 0.0}
_SHOWN_AWAY = QColor(Qt.GlobalColor.gray)


class RobotsModel(QAbstractTableModel):
    """A row for each robot, by name: ticked when it takes part, with its settings."""

    edited = pyqtSignal(str, object)
    """The operator changed a robot: its name and its new RobotSettings."""
    refused = pyqtSignal(str)
    """An entry is not a valid number for a robot; the value is unchanged."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._names: list[str] = []
        self._there: list[bool] = []
        self._settings = PlanSettings()

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._names)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(HEADS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        is_head = orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole
        return HEADS[section] if is_head else None

    def flags(self, index: QModelIndex) -> Qt.ItemFlag:
        more = Qt.ItemFlag.ItemIsEditable if index.column() else Qt.ItemFlag.ItemIsUserCheckable
        return super().flags(index) | more

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if index.column() == 0:
            return self._about(index.row(), role)
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return f"{getattr(self._of(index.row()), _FIELDS[index.column()]):g}"
        return TO_THE_RIGHT if role == Qt.ItemDataRole.TextAlignmentRole else None

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        column = index.column()
        if column == 0 and role == Qt.ItemDataRole.CheckStateRole:
            value_set: float | None = number_of(value) == CHECKED
        elif column and role == Qt.ItemDataRole.EditRole:
            value_set = self._number(index.row(), column, str(value))
        else:
            return False
        if value_set is None:
            return False
        name = self._names[index.row()]
        one = replace(self._of(index.row()), **{_FIELDS[column]: value_set})
        self._settings = self._settings.with_robot(name, one)
        self.dataChanged.emit(index, index)
        self.edited.emit(name, one)
        return True

    def show_robots(self, names: Sequence[str], there: Sequence[bool], settings: PlanSettings) -> None:
        """Show the robots ``names`` with their ``settings``; ``there`` says whether each can take part.

        Only changes are signalled: with a thousand robots some come or go at any moment, and an open editor
        must not lose what is being typed.
        """
        self._show_settings(settings)
        if names != self._names:
            self._show_names(names, there)
        changed = [row for row, (new, old) in enumerate(zip(there, self._there, strict=True)) if new != old]
        if changed:
            self._there = list(there)
            roles = [Qt.ItemDataRole.ForegroundRole, Qt.ItemDataRole.ToolTipRole]
            self.dataChanged.emit(self.index(changed[0], 0), self.index(changed[-1], 0), roles)

    def _show_settings(self, settings: PlanSettings) -> None:
        before, self._settings = self._settings, settings
        if settings.robots != before.robots and self._names:
            self.dataChanged.emit(self.index(0, 0), self.index(len(self._names) - 1, len(HEADS) - 1))

    def _show_names(self, names: Sequence[str], there: Sequence[bool]) -> None:
        known = set(self._names)
        if not known <= set(names):
            self.beginResetModel()
            self._names, self._there = list(names), list(there)
            self.endResetModel()
            return
        for first, last in _newcomers(names, known):
            self.beginInsertRows(QModelIndex(), first, last)
            self._names[first:first] = names[first : last + 1]
            self._there[first:first] = there[first : last + 1]
            self.endInsertRows()

    def _of(self, row: int) -> PlanRobotSettings:
        return self._settings.of_robot(self._names[row])

    def _about(self, row: int, role: int) -> object:
        name, there = self._names[row], self._there[row]
        if role == Qt.ItemDataRole.DisplayRole:
            return name
        if role == Qt.ItemDataRole.CheckStateRole:
            return CHECKED if self._of(row).used else UNCHECKED
        if role == Qt.ItemDataRole.ForegroundRole and not there:
            return _SHOWN_AWAY
        if role == Qt.ItemDataRole.ToolTipRole and not there:
            return tr("{name} is away: it takes no part", name=name)
        return None

    def _number(self, row: int, column: int, text: str) -> float | None:
        """Return the number in ``text``; None, and report it, where the column cannot hold it."""
        field = _FIELDS[column]
        kind = type(getattr(PlanRobotSettings(), field))
        try:
            number = kind(text.strip().replace(",", "."))
            if not _LEAST[field] <= number < 1e7:
                raise ValueError
        except ValueError:
            self.refused.emit(
                tr(
                    "{column} of {robot} is {text!r}: give {least:g} or more.",
                    column=HEADS[column],
                    robot=self._names[row],
                    text=text.strip(),
                    least=_LEAST[field],
                )
            )
            return None
        return number


def _newcomers(names: Sequence[str], known: set[str]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last row of each run of ``names`` that are not ``known``."""
    row = 0
    for is_new, run in groupby(names, key=lambda name: name not in known):
        count = len(list(run))
        if is_new:
            yield row, row + count - 1
        row += count


# --- The table of the robots available for a plan: selection, cones carried, speed, range ---

SHOWN = 6
"""Rows that are visible without scrolling."""
WIDEST = ("", "100", "100", "0.05", "10000")
"""The widest text that each column has room for, if its head needs less."""
BESIDE_TEXT = 10
"""Width in pixels of the edges of a cell."""


class RobotsForm(QTableView):
    """A row for each known robot; a range of 0 means no limit."""

    edited = pyqtSignal(str, object)
    """The operator changed a robot: its name and its new RobotSettings."""
    refused = pyqtSignal(str)
    """An entry is not a valid number for a robot."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_plan_robots")
        self._model = RobotsModel(self)
        self._model.edited.connect(self.edited)
        self._model.refused.connect(self.refused)
        self.setModel(self._model)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(22)
        self._fit_columns()
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setToolTip(
            tr("Aboard: cones on the robot now. Range: metres of battery, 0 if it does not matter")
        )
        self._fit_height()

    def show_robots(self, desk: FleetController, settings: PlanSettings) -> None:
        """Show the robots known to ``desk`` now, with their settings."""
        robots, rows = desk.state.robots.arrays(desk.clock.steady()), desk.state.robots.by_name()
        there = available_robots(robots).tolist()
        count = self._model.rowCount()
        self._model.show_robots([robots.names[row] for row in rows], [there[row] for row in rows], settings)
        if self._model.rowCount() != count:
            self._fit_height()

    def _fit_columns(self) -> None:
        """Give the columns of numbers a fixed width: fitted to their contents, a thousand robots would be
        measured at each change of one."""
        heads = self.horizontalHeader()
        heads.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        heads.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        widths = [
            max(heads.sectionSizeHint(column), self.fontMetrics().horizontalAdvance(widest) + BESIDE_TEXT)
            for column, widest in enumerate(WIDEST)
        ]
        for column, width in enumerate(widths):
            heads.resizeSection(column, width)
        self.setMinimumWidth(sum(widths) + 2 * self.frameWidth())

    def _fit_height(self) -> None:
        """Set the height to that of the rows, up to a limit."""
        row, head = self.verticalHeader().defaultSectionSize(), self.horizontalHeader().sizeHint().height()
        shown = min(max(self._model.rowCount(), 2), SHOWN)
        self.setFixedHeight(head + row * shown + 2 * self.frameWidth() + 2)
