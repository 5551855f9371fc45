"""Widget in algorithms' dialogs for a choice whose values have display names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from processing.gui.wrappers import WidgetWrapper
from qgis.core import QgsProcessingParameterEnum
from qgis.gui import QgsCheckableComboBox, QgsGui
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QComboBox, QWidget

MODELER = "ModelerParametersDialog"
"""The class of the dialog for a step of a model."""
ROOM = 30
"""Letters that a list has room for at least."""


class ChoiceWidget(WidgetWrapper):
    """A list of names, of which one can be chosen, or several can be ticked, for the value of each.

    Processing creates it from the metadata of the parameter (``widget_wrapper``).
    """

    def __new__(cls, parameter: QgsProcessingParameterEnum, dialog: Any, *_: Any, **__: Any) -> Any:
        if type(dialog).__name__ == MODELER:
            # In a model a value can come from another step, which only QGIS's own widget offers.
            registry = QgsGui.processingGuiRegistry()
            return registry.createModelerParameterWidget(
                dialog.model, dialog.childId, parameter, dialog.context
            )
        return super().__new__(cls)

    def createWidget(self, names: Mapping[str, str]) -> QWidget:
        parameter = self.parameterDefinition()
        # Not in the order of the names: metadata comes back from QGIS sorted by its keys.
        values = parameter.options()
        self._several = parameter.allowMultiple()
        box = self._to_tick(values, names) if self._several else self._to_choose(values, names)
        # QGIS scrolls its dialog sideways for wider ones; the open list shows each name in full.
        box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        box.setMinimumContentsLength(ROOM)
        return box

    def _to_tick(self, values: Sequence[str], names: Mapping[str, str]) -> QComboBox:
        box = QgsCheckableComboBox()
        for value in values:
            box.addItemWithCheckState(names[value], Qt.CheckState.Unchecked, value)
        box.checkedItemsChanged.connect(lambda *_: self.widgetValueHasChanged.emit(self))
        return box

    def _to_choose(self, values: Sequence[str], names: Mapping[str, str]) -> QComboBox:
        box = QComboBox()
        for value in values:
            box.addItem(names[value], value)
        box.currentIndexChanged.connect(lambda *_: self.widgetValueHasChanged.emit(self))
        return box

    def setValue(self, value: Any) -> None:
        if not self._several:
            self.widget.setCurrentIndex(self.widget.findData(value))
            return
        chosen = value.split(",") if isinstance(value, str) else value or ()
        for row in range(self.widget.count()):
            state = Qt.CheckState.Checked if self.widget.itemData(row) in chosen else Qt.CheckState.Unchecked
            self.widget.setItemCheckState(row, state)

    def value(self) -> Any:
        return self.widget.checkedItemsData() if self._several else self.widget.currentData()
