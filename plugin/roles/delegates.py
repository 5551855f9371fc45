"""How the cells of the role table are edited: a list of roles, and QGIS's field and expression chooser."""

from __future__ import annotations

from qgis.core import QgsExpressionContextUtils, QgsProject, QgsVectorLayer
from qgis.gui import QgsFieldExpressionWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QComboBox, QStyledItemDelegate

from .table_model import role_name


class RoleDelegate(QStyledItemDelegate):
    """Offers the roles that a layer can have."""

    def createEditor(self, parent, option, index):
        editor = QComboBox(parent)
        for role in index.model().rows[index.row()].roles:
            editor.addItem(role_name(role), role)
        # One click chooses: without this the list closes and the cell waits for another key.
        editor.activated.connect(lambda _: self._take(editor))
        return editor

    def setEditorData(self, editor, index):
        editor.setCurrentIndex(max(editor.findData(index.data(Qt.ItemDataRole.EditRole)), 0))

    def setModelData(self, editor, model, index):
        model.setData(index, editor.currentData())

    def _take(self, editor: QComboBox) -> None:
        self.commitData.emit(editor)
        self.closeEditor.emit(editor)


class ExpressionDelegate(QStyledItemDelegate):
    """Lets one choose a field of the layer, or write an expression or build it in QGIS's dialog."""

    def createEditor(self, parent, option, index):
        layer = index.model().layer(index)
        editor = QgsFieldExpressionWidget(parent)
        editor.setAllowEmptyFieldName(True)
        editor.setAutoFillBackground(True)
        if isinstance(layer, QgsVectorLayer):
            editor.setLayer(layer)
            editor.appendScope(QgsExpressionContextUtils.projectScope(QgsProject.instance()))
        return editor

    def setEditorData(self, editor, index):
        editor.setExpression(index.data(Qt.ItemDataRole.EditRole) or "")

    def setModelData(self, editor, model, index):
        model.setData(index, editor.asExpression())
