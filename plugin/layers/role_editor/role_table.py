"""The table of layers and roles: rows, Qt model and cell editors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

from qgis.core import (
    QgsExpressionContextUtils,
    QgsMapLayer,
    QgsProject,
    QgsRasterLayer,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.gui import QgsFieldExpressionWidget
from qgis.PyQt.QtCore import QAbstractItemModel, QAbstractTableModel, QModelIndex, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QComboBox, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from ....robot_bridge.core.robotmap.parametric_shapes import NAMED
from ...ui.glyphs import DOUBTFUL, WRONG, for_letters
from ...ui.language import first_of, tr
from .. import roles
from ..live_layers import MARK
from ..roles import LayerSetup
from .preview import COLOURS, LayerMeasure

# --- The rows of the role table: one for each layer of the project that can have a role ---

_LINES = (roles.OBSTACLE, roles.STAIRS, roles.FURNITURE, roles.ROAD_CENTRELINE)
_POLYGONS = (roles.OBSTACLE, roles.RAMP, roles.FURNITURE, roles.ROAD_SURFACE, roles.KEEPOUT)
_CHOICES = {
    QgsWkbTypes.GeometryType.PointGeometry: (roles.FURNITURE,),
    QgsWkbTypes.GeometryType.LineGeometry: _LINES,
    QgsWkbTypes.GeometryType.PolygonGeometry: _POLYGONS,
    QgsWkbTypes.GeometryType.UnknownGeometry: tuple(dict.fromkeys((*_LINES, *_POLYGONS))),
}


@dataclass
class RoleRow:
    """A layer and its setup in the dialog; id and name remain valid when the layer is gone."""

    layer: QgsRasterLayer | QgsVectorLayer
    layer_id: str
    name: str
    setup: LayerSetup

    @property
    def roles(self) -> tuple[str, ...]:
        """The roles available for the layer, and its present one however odd; ``""`` is none."""
        if isinstance(self.layer, QgsRasterLayer):
            choices: tuple[str, ...] = (roles.ORTHOPHOTO,)
        else:
            choices = _CHOICES.get(self.layer.geometryType(), ())
        return tuple(dict.fromkeys(("", *choices, self.setup.role)))

    def change(self, what: str, text: str) -> None:
        """Set ``role`` or one of the expressions."""
        text = text.strip()
        if what == "role":
            self.setup = replace(self.setup, role=text)
        else:
            self.setup = replace(self.setup, expressions=replace(self.setup.expressions, **{what: text}))


def role_rows(project: QgsProject) -> list[RoleRow]:
    """Return a row for each layer that can have a role, by name; live robot layers have none."""
    layers = [layer for layer in project.mapLayers().values() if _can_have_a_role(layer)]
    return [
        RoleRow(layer, layer.id(), layer.name(), roles.setup_of(layer))
        for layer in sorted(layers, key=lambda layer: (layer.name().lower(), layer.id()))
    ]


def _can_have_a_role(layer: QgsMapLayer) -> bool:
    if layer.customProperty(MARK):
        return False
    if isinstance(layer, QgsVectorLayer):
        return layer.isValid() and layer.isSpatial() and layer.geometryType() in _CHOICES
    return isinstance(layer, QgsRasterLayer)


# --- The role table as Qt shows and edits it ---

TITLES = (
    tr("Layer"),
    tr("Role"),
    tr("Filter"),
    tr("Height [m]"),
    tr("Estimate [m]"),
    tr("Foot [m]"),
    tr("Label"),
    tr("Outdoors"),
    tr("Width [m]"),
    tr("Template"),
    tr("Turned [°]"),
    tr("Comes to"),
)
LAYER, ROLE, FILTER, HEIGHT, ESTIMATE, BASE, SEMANTICS, OUTDOOR, WIDTH, TEMPLATE, ROTATION, RESULT = range(12)
WHAT = {
    ROLE: "role",
    FILTER: "filter",
    HEIGHT: "height",
    ESTIMATE: "estimate",
    BASE: "base",
    SEMANTICS: "semantics",
    OUTDOOR: "outdoor",
    WIDTH: "width",
    TEMPLATE: "template",
    ROTATION: "rotation",
}
EXPLANATIONS = {
    LAYER: tr("Layers of the project that can have a role"),
    ROLE: tr("What the layer is to robots and operators"),
    FILTER: tr(
        "Expression that is true of the features that count, such as \"amenity\" = 'bench'; empty: all"
    ),
    HEIGHT: tr("Expression for metres from the foot up; empty: the field height or height_m"),
    ESTIMATE: tr(
        'Expression for the height where it is not known, such as 3 * "levels"; marked as estimated'
    ),
    BASE: tr("Expression for metres above the ground where it begins, as of an arch; empty: 0"),
    SEMANTICS: tr("Expression for the label, such as 'building,' || \"name\"; of a road its surface"),
    OUTDOOR: tr("Expression for true or false; empty: true"),
    WIDTH: tr("Expression for the metres across, of a road or of furniture that is points"),
    TEMPLATE: tr(
        "Expression for the shape that a point of furniture stands for: {shapes}, 'circle 0.6', 'square 1' "
        "or 'rectangle 2 0.5'; empty: an octagon of its width",
        shapes=", ".join(map(repr, NAMED)),
    ),
    ROTATION: tr("Expression for the degrees clockwise that the template is turned; empty: 0"),
    RESULT: tr("What is published of the layer"),
}
ROLE_NAMES = {
    "": "–",
    roles.OBSTACLE: tr("obstacle"),
    roles.STAIRS: tr("stairs"),
    roles.RAMP: tr("ramp"),
    roles.FURNITURE: tr("furniture"),
    roles.ROAD_CENTRELINE: tr("road centreline"),
    roles.ROAD_SURFACE: tr("road surface"),
    roles.KEEPOUT: tr("keepout"),
    roles.ORTHOPHOTO: tr("orthophoto"),
}

_GREY = QColor("#8a949e")
LISTED = 20
"""Warnings of a layer in its tool tip."""


def role_name(role: str) -> str:
    """Return the display name of a role."""
    return ROLE_NAMES.get(role, role)


def used_columns(role: str) -> tuple[int, ...]:
    """Return the columns of expressions that count for a layer of ``role``."""
    if role in roles.OBSTACLE_ROLES:
        columns = (FILTER, HEIGHT, ESTIMATE, BASE, SEMANTICS, OUTDOOR)
        return (*columns, WIDTH, TEMPLATE, ROTATION) if role == roles.FURNITURE else columns
    if role == roles.ROAD_CENTRELINE:
        return (FILTER, SEMANTICS, WIDTH)
    return () if role in ("", roles.ORTHOPHOTO) else (FILTER, SEMANTICS)


class RoleTableModel(QAbstractTableModel):
    """Rows of :class:`RoleRow`; ``edited`` signals a change of one or more of them."""

    edited = pyqtSignal()

    def __init__(self, rows: Sequence[RoleRow], parent: QWidget | None = None):
        super().__init__(parent)
        self.rows = list(rows)
        self._results: dict[str, LayerMeasure | None] = {}

    def show_result(self, layer_id: str, found: LayerMeasure | None) -> None:
        """Show the measure of a layer; None while that is being computed."""
        for k, row in enumerate(self.rows):
            if row.layer_id == layer_id:
                self._results[layer_id] = found
                self.dataChanged.emit(self.index(k, RESULT), self.index(k, RESULT))

    def set_up(self, setups: dict[str, LayerSetup]) -> None:
        """Change several layers at once, by their ids."""
        for row in self.rows:
            row.setup = setups.get(row.layer_id, row.setup)
        if self.rows:
            self.dataChanged.emit(self.index(0, 0), self.index(len(self.rows) - 1, RESULT))
        self.edited.emit()

    def layer(self, index: QModelIndex) -> QgsMapLayer:
        """Return the layer of a row."""
        return self.rows[index.row()].layer

    # --- Qt ---

    def rowCount(self, parent: QModelIndex = QModelIndex()):  # noqa: B008
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: QModelIndex = QModelIndex()):  # noqa: B008
        return 0 if parent.isValid() else len(TITLES)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole):
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return TITLES[section]
        return EXPLANATIONS[section] if role == Qt.ItemDataRole.ToolTipRole else None

    def flags(self, index: QModelIndex):
        plain = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        column = index.column()
        editable = column == ROLE or column in used_columns(self.rows[index.row()].setup.role)
        return plain | Qt.ItemFlag.ItemIsEditable if editable else plain

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole):
        row, column = self.rows[index.row()], index.column()
        if role == Qt.ItemDataRole.EditRole:
            return self._text(row, column)
        if role == Qt.ItemDataRole.DisplayRole:
            return self._shown(row, column)
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._explained(row, column)
        if role == Qt.ItemDataRole.ForegroundRole:
            return self._colour(row, column)
        if role == Qt.ItemDataRole.DecorationRole and column == ROLE:
            return COLOURS.get(row.setup.role)
        return None

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole):
        row, column = self.rows[index.row()], index.column()
        if role != Qt.ItemDataRole.EditRole or column not in WHAT:
            return False
        before = row.setup
        row.change(WHAT[column], str(value or ""))
        if row.setup != before:
            self.dataChanged.emit(self.index(index.row(), 0), self.index(index.row(), RESULT))
            self.edited.emit()
        return True

    def _text(self, row: RoleRow, column: int) -> str:
        if column in WHAT and column != ROLE:
            return str(getattr(row.setup.expressions, WHAT[column]))
        return row.setup.role if column == ROLE else row.name

    def _shown(self, row: RoleRow, column: int) -> str:
        if column == RESULT:
            found = self._results.get(row.layer_id)
            measured = row.setup.role and row.setup.role != roles.ORTHOPHOTO
            return str(found) if found is not None else ("…" if measured else "")
        if column == ROLE:
            return role_name(row.setup.role)
        if column in WHAT and column not in used_columns(row.setup.role):
            return ""
        return self._text(row, column)

    def _explained(self, row: RoleRow, column: int) -> str:
        if column != RESULT:
            return self._shown(row, column)
        found = self._results.get(row.layer_id)
        if found is None:
            return ""
        return found.refused or "\n".join(first_of(found.warnings, LISTED))

    def _colour(self, row: RoleRow, column: int) -> Any:
        found = self._results.get(row.layer_id)
        if column == RESULT and found is not None and (found.refused or found.warnings):
            return for_letters(WRONG if found.refused else DOUBTFUL)
        return _GREY if not row.setup.role else None


# --- Editors of the role table's cells: a list of roles, and QGIS's field and expression chooser


class RoleDelegate(QStyledItemDelegate):
    """Offers the roles available for a layer."""

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: QModelIndex):
        editor = QComboBox(parent)
        for role in _table(index).rows[index.row()].roles:
            editor.addItem(role_name(role), role)
        # One click chooses: without this the list closes and the cell waits for another key.
        editor.activated.connect(lambda _: self._apply(editor))
        return editor

    def setEditorData(self, editor: QComboBox, index: QModelIndex):
        editor.setCurrentIndex(max(editor.findData(index.data(Qt.ItemDataRole.EditRole)), 0))

    def setModelData(self, editor: QComboBox, model: QAbstractItemModel, index: QModelIndex):
        model.setData(index, editor.currentData())

    def _apply(self, editor: QComboBox) -> None:
        self.commitData.emit(editor)
        self.closeEditor.emit(editor)


class ExpressionDelegate(QStyledItemDelegate):
    """Editor to choose a field of the layer, or to enter or build an expression in QGIS's dialog."""

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: QModelIndex):
        layer = _table(index).layer(index)
        editor = QgsFieldExpressionWidget(parent)
        editor.setAllowEmptyFieldName(True)
        editor.setAutoFillBackground(True)
        if isinstance(layer, QgsVectorLayer):
            editor.setLayer(layer)
            editor.appendScope(QgsExpressionContextUtils.projectScope(QgsProject.instance()))
        return editor

    def setEditorData(self, editor: QgsFieldExpressionWidget, index: QModelIndex):
        editor.setExpression(index.data(Qt.ItemDataRole.EditRole) or "")

    def setModelData(self, editor: QgsFieldExpressionWidget, model: QAbstractItemModel, index: QModelIndex):
        model.setData(index, editor.asExpression())


def _table(index: QModelIndex) -> RoleTableModel:
    return cast(RoleTableModel, index.model())
