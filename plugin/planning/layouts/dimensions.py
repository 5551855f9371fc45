"""The window beside the map for editing a layout's dimensions before it is placed."""

from __future__ import annotations

from qgis.core import QgsSettings
from qgis.gui import QgsDoubleSpinBox
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtGui import QWheelEvent
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.core.errors import ConeCountError, DimensionError
from ....robot_bridge.core.layouts.layout import MOST_CONES, Dimension, DimensionFault, Layout
from ...cone_texts import (
    DIMENSION_CHOICES,
    LAYOUT_TITLES,
    dimension_in_words,
    fault_in_words,
    standard_in_words,
)
from ...ui.glyphs import WRONG_STYLE
from ...ui.language import tr

GROUP = "fleet_supervisor/layouts"
_WIDTH = 140
"""Pixels of a field."""
_FURTHEST = 1e6
"""Greatest absolute value in a field: a wrong number is reported, and not silently clipped."""


class NumberField(QgsDoubleSpinBox):
    """A number with as many decimals as it has; its button resets it to the standard's.

    The wheel scrolls past it: a dimension must not change by accident while scrolling.
    """

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()

    def textFromValue(self, value: float) -> str:
        return self.locale().toString(value, "g", 9)


class ChoiceField(QComboBox):
    """A choice that ignores the wheel, like :class:`NumberField`."""

    def wheelEvent(self, event: QWheelEvent) -> None:
        event.ignore()


class LayoutDimensions(QDialog):
    """A field for each dimension, and one for the heading. Errors are shown and not applied."""

    changed = pyqtSignal(object)
    """The layout with the present dimensions, all of them valid."""
    turned = pyqtSignal(float)
    """The heading that the operator gave, degrees clockwise from north."""
    undo_requested = pyqtSignal()
    """The operator wants to undo the placing of the last layout."""
    left = pyqtSignal()
    """The operator has finished here: the map gets the focus again."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_layout_dimensions")
        # The map keeps the focus until the operator comes here.
        self.setAttribute(Qt.WidgetAttribute.WA_ShowWithoutActivating)
        self._kind: type[Layout] | None = None
        self._fields: dict[str, NumberField | QComboBox] = {}
        self.standard, self.problem = _text("standard"), _text("problem")
        self.problem.setStyleSheet(WRONG_STYLE)
        self.heading = _number("fleet_layout_heading", " °")
        self.heading.setFixedWidth(_WIDTH)
        self.heading.setShowClearButton(False)
        self.heading.setRange(0.0, 359.9)
        self.heading.setWrapping(True)
        self.heading.setDecimals(1)
        self.heading.setToolTip(tr("Degrees clockwise from north; the wheel over the map turns it too"))
        self.heading.valueChanged.connect(self.turned)
        self.reset = QPushButton(tr("Reset to the standard"))
        self.reset.setObjectName("fleet_layout_reset")
        self.reset.setAutoDefault(False)
        self.reset.clicked.connect(lambda: self._fill(self._kind.of({})))
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        rows = QVBoxLayout(self)
        self.undo = QPushButton(tr("Take back the last layout"))
        self.undo.setObjectName("fleet_layout_undo")
        self.undo.setAutoDefault(False)
        self.undo.setEnabled(False)
        self.undo.setToolTip(tr("Remove the cones that were placed last; Ctrl+Z over the map does so too"))
        self.undo.clicked.connect(self.undo_requested)
        for widget in (self.standard, self._area, self.problem, self.reset, self.undo):
            rows.addWidget(widget)
        self.resize(460, 480)

    def show_layout(self, layout: Layout, heading: float) -> None:
        """Show the dimensions of ``layout`` for editing."""
        self._kind = type(layout)
        self.setWindowTitle(LAYOUT_TITLES[layout.NAME])
        self.standard.setText(standard_in_words(self._kind))
        form = QFormLayout()
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.DontWrapRows)
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.FieldsStayAtSizeHint)
        self.heading.setParent(None)
        form.addRow(tr("Heading"), self.heading)
        self._fields = {one.name: self._field(one) for one in layout.dimensions()}
        for one in layout.dimensions():
            label = QLabel(dimension_in_words(self._kind, one))
            label.setWordWrap(True)
            label.setMinimumWidth(200)
            label.setBuddy(self._fields[one.name])
            form.addRow(label, self._fields[one.name])
        body = QWidget()
        body.setLayout(form)
        self._area.setWidget(body)
        self.show_heading(heading)
        self._fill(layout)
        if not self.testAttribute(Qt.WidgetAttribute.WA_Moved):
            self._move_to_corner()
        self.show()

    def _move_to_corner(self) -> None:
        """Move to the lower left corner of the window: Qt would begin in its middle, where the cones go."""
        window = self.parentWidget().window().geometry()
        self.move(window.left(), window.bottom() + 1 - self.height())

    def show_heading(self, heading: float) -> None:
        """Show the heading of the layout."""
        self.heading.blockSignals(True)
        self.heading.setValue(heading)
        self.heading.blockSignals(False)

    def focus_heading(self) -> None:
        """Set the focus in this window."""
        self.show()
        self.activateWindow()
        self.heading.setFocus()
        self.heading.selectAll()

    def reject(self) -> None:
        super().reject()
        self.left.emit()

    def _field(self, one: Dimension) -> NumberField | QComboBox:
        field = self._choice(one) if one.choices else self._number(one)
        field.setObjectName(f"fleet_layout_{one.name}")
        field.setFixedWidth(_WIDTH)
        unit = f" {one.unit}" if one.unit else ""
        standard = DIMENSION_CHOICES[one.choices[one.standard]] if one.choices else f"{one.standard:g}{unit}"
        field.setToolTip(tr("Standard: {value}", value=standard))
        return field

    def _choice(self, one: Dimension) -> QComboBox:
        field = ChoiceField()
        for choice, name in one.choices.items():
            field.addItem(DIMENSION_CHOICES[name], choice)
        field.currentIndexChanged.connect(self._edited)
        return field

    def _number(self, one: Dimension) -> NumberField:
        field = _number("", f" {one.unit}" if one.unit else "")
        field.setDecimals(0 if one.whole else 4)
        field.setClearValue(one.standard)
        field.valueChanged.connect(self._edited)
        return field

    def _fill(self, layout: Layout) -> None:
        for one in layout.dimensions():
            field, value = self._fields[one.name], getattr(layout, one.name)
            field.blockSignals(True)
            if isinstance(field, QComboBox):
                field.setCurrentIndex(field.findData(value))
            else:
                field.setValue(value)
            field.blockSignals(False)
        self._edited()

    def _edited(self, *_: object) -> None:
        """Apply the values in the fields, or show what is wrong with them."""
        values = {name: _value(field) for name, field in self._fields.items()}
        wrong = []
        for one in self._kind.dimensions():
            fault = one.fault(values[one.name])
            self._mark(one, values[one.name], fault)
            if fault is not None:
                wrong.append(f"{dimension_in_words(self._kind, one)}: {fault_in_words(one, fault)}.")
        layout = None if wrong else self._layout(values, wrong)
        self.problem.setText("\n".join(wrong))
        self.problem.setVisible(bool(wrong))
        if layout is not None:
            remember(self._kind, values)
            self.changed.emit(layout)

    def _layout(self, values: dict[str, float], wrong: list[str]) -> Layout | None:
        """Return the layout, or None and append to ``wrong`` what keeps its values from going together."""
        try:
            layout = self._kind.of(values)
            layout.spots()
        except ConeCountError as error:
            (one,) = (one for one in self._kind.dimensions() if one.name == error.dimension)
            many = tr("too many cones; a plan has {most} at most", most=MOST_CONES)
            wrong.append(f"{dimension_in_words(self._kind, one)}: {many}.")
        except DimensionError as error:
            wrong.append(str(error))
        else:
            return layout
        return None

    def _mark(self, one: Dimension, value: float, fault: DimensionFault | None) -> None:
        """Mark an error, and a value that differs from the standard."""
        font = self._fields[one.name].font()
        font.setBold(value != one.standard)
        self._fields[one.name].setFont(font)
        self._fields[one.name].setStyleSheet(WRONG_STYLE if fault is not None else "")


def remembered(kind: type[Layout]) -> Layout:
    """Return the layout with the dimensions used last, where there are any that are valid for it."""
    settings, values = QgsSettings(), {}
    for one in kind.dimensions():
        value = settings.value(_key(kind, one.name), None)
        try:
            number = float(value)
        except (TypeError, ValueError):
            continue
        if one.fault(number) is None:
            values[one.name] = number
    try:
        return kind.of(values)
    except DimensionError:
        return kind.of({})


def remember(kind: type[Layout], values: dict[str, float]) -> None:
    """Store the dimensions that differ from the standard's, in the user's profile."""
    settings = QgsSettings()
    for one in kind.dimensions():
        if values[one.name] == one.standard:
            settings.remove(_key(kind, one.name))
        else:
            settings.setValue(_key(kind, one.name), values[one.name])


def _key(kind: type[Layout], name: str) -> str:
    return f"{GROUP}/{kind.NAME}/{name}"


def _value(field: NumberField | QComboBox) -> float:
    return field.currentData() if isinstance(field, QComboBox) else field.value()


def _number(name: str, suffix: str) -> NumberField:
    field = NumberField()
    field.setObjectName(name)
    field.setRange(-_FURTHEST, _FURTHEST)
    field.setSuffix(suffix)
    field.setKeyboardTracking(False)
    return field


def _text(name: str) -> QLabel:
    label = QLabel()
    label.setObjectName(f"fleet_layout_{name}")
    label.setWordWrap(True)
    return label
