"""How the cells of the role table are edited: a list of roles, and QGIS's field and expression chooser."""

from __future__ import annotations

from typing import cast

from qgis.core import QgsExpressionContextUtils, QgsProject, QgsVectorLayer
from qgis.gui import QgsFieldExpressionWidget
from qgis.PyQt.QtCore import QAbstractItemModel, QModelIndex, Qt
from qgis.PyQt.QtWidgets import QComboBox, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from .table_model import RoleTableModel, role_name


class RoleDelegate(QStyledItemDelegate):
    """Offers the roles that a layer can have."""

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: QModelIndex):
        editor = QComboBox(parent)
        for role in _table(index).rows[index.row()].roles:
            editor.addItem(role_name(role), role)
        # One click chooses: without this the list closes and the cell waits for another key.
        editor.activated.connect(lambda _: self._take(editor))
        return editor

    def setEditorData(self, editor: QComboBox, index: QModelIndex):
        editor.setCurrentIndex(max(editor.findData(index.data(Qt.ItemDataRole.EditRole)), 0))

    def setModelData(self, editor: QComboBox, model: QAbstractItemModel, index: QModelIndex):
        model.setData(index, editor.currentData())

    def _take(self, editor: QComboBox) -> None:
        self.commitData.emit(editor)
        self.closeEditor.emit(editor)


class ExpressionDelegate(QStyledItemDelegate):
    """Lets one choose a field of the layer, or write an expression or build it in QGIS's dialog."""

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
