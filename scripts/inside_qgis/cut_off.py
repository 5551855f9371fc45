"""Finds what an operator cannot read or reach: texts that do not fit, widgets that others cover or clip."""

from __future__ import annotations

from collections.abc import Iterator

from qgis.gui import QgsMessageBarItem
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAbstractScrollArea,
    QApplication,
    QComboBox,
    QHeaderView,
    QLabel,
    QLineEdit,
    QStyle,
    QStyleOptionComboBox,
    QTabBar,
    QTableView,
    QTextEdit,
    QWidget,
)
from qgis.utils import iface

OURS = "fleet_"
SLACK = 1
"""Pixels that styles round by."""


def what_is_cut_off() -> list[str]:
    """Return what is wrong with each visible part of the plugin, in words; an empty list when nothing is."""
    found = []
    for widget in _shown():
        found += [f"{_name(widget)}: {fault}" for fault in _faults(widget)]
    found += _beyond_the_screen(iface.mainWindow())
    for item in iface.messageBar().findChildren(QgsMessageBarItem):
        found += [f"message bar: {fault}" for fault in _cut_message(item)]
    return found


def _shown() -> Iterator[QWidget]:
    """The plugin's docks, dialogs and panels with all that is in them."""
    tops = [widget for widget in QApplication.allWidgets() if _is_top(widget)]
    for top in tops:
        yield from (part for part in [top, *top.findChildren(QWidget)] if part.isVisible())


def _is_top(widget: QWidget) -> bool:
    return widget.objectName().startswith(OURS) and widget.isVisible() and not _is_inside_ours(widget)


def _is_inside_ours(widget: QWidget) -> bool:
    parent = widget.parentWidget()
    return parent is not None and (parent.objectName().startswith(OURS) or _is_inside_ours(parent))


def _faults(widget: QWidget) -> Iterator[str]:
    if _text_does_not_fit(widget):
        yield f"{_text(widget)!r} does not fit into {_size(widget.size())}, it takes {_size(_wanted(widget))}"
    if isinstance(widget, QHeaderView):
        yield from _cut_heads(widget)
    if isinstance(widget, QTableView):
        yield from _cut_cells(widget)
    if _has_something_to_read(widget) and not _scrolls(widget):
        seen = widget.visibleRegion().boundingRect()
        if seen.width() < widget.width() - SLACK or seen.height() < widget.height() - SLACK:
            yield f"{_text(widget)!r} is seen only in part: {_size(seen.size())} of {_size(widget.size())}"


def _text_does_not_fit(widget: QWidget) -> bool:
    if isinstance(widget, QLineEdit):
        # What is being typed may be longer than its field.
        return not widget.hasFocus() and _wanted(widget).width() > widget.width() + SLACK
    if isinstance(widget, QTabBar):
        return _wanted(widget).width() > widget.width() + SLACK
    if not isinstance(widget, (QLabel, QAbstractButton, QComboBox)) or not _text(widget):
        return False
    wanted = _wanted(widget)
    return wanted.width() > widget.width() + SLACK or wanted.height() > widget.height() + SLACK


def _wanted(widget: QWidget) -> QSize:
    """Return the size that the whole of a widget's text takes."""
    if isinstance(widget, QLabel) and widget.wordWrap():
        return QSize(widget.width(), widget.heightForWidth(widget.width()))
    if isinstance(widget, QComboBox):
        return _wanted_by_combo(widget)
    if isinstance(widget, QLineEdit):
        # A field keeps two pixels left and right of its text.
        return QSize(widget.fontMetrics().horizontalAdvance(_text(widget)) + 4, 0)
    if isinstance(widget, QAbstractButton):
        return QSize(widget.minimumSizeHint().width(), widget.minimumSizeHint().height())
    return widget.sizeHint()


def _wanted_by_combo(combo: QComboBox) -> QSize:
    option = QStyleOptionComboBox()
    combo.initStyleOption(option)
    room = combo.style().subControlRect(
        QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, combo
    )
    text = combo.fontMetrics().horizontalAdvance(combo.currentText())
    return QSize(combo.width() + text - room.width(), 0)


def _beyond_the_screen(window: QWidget) -> Iterator[str]:
    screen = QApplication.primaryScreen().geometry()
    if not screen.contains(window.frameGeometry()):
        yield f"the window is {_size(window.size())}, beyond the screen of {_size(screen.size())}"


def _cut_message(item: QgsMessageBarItem) -> Iterator[str]:
    for text in item.findChildren(QTextEdit):
        if text.isVisible() and text.document().size().height() > text.viewport().height() + SLACK:
            yield f"{text.toPlainText()!r} does not fit into {_size(text.viewport().size())}"


def _cut_heads(header: QHeaderView) -> Iterator[str]:
    model = header.model()
    for number in range(header.count()):
        if header.isSectionHidden(number) or header.orientation() != Qt.Orientation.Horizontal:
            continue
        text = str(model.headerData(number, header.orientation()) or "")
        if header.fontMetrics().horizontalAdvance(text) > header.sectionSize(number):
            yield f"the head {text!r} does not fit into {header.sectionSize(number)} px"


def _cut_cells(table: QTableView) -> Iterator[str]:
    model = table.model()
    beside = 2 * (table.style().pixelMetric(QStyle.PixelMetric.PM_FocusFrameHMargin) + 1)
    for row in range(model.rowCount()):
        for column in range(model.columnCount()):
            index, width = model.index(row, column), table.columnWidth(column)
            text = str(index.data() or "")
            wanted = table.fontMetrics().horizontalAdvance(text) + beside if text else 0
            if index.data(Qt.ItemDataRole.DecorationRole) is not None:
                wanted += table.style().pixelMetric(QStyle.PixelMetric.PM_SmallIconSize) + beside
            if 0 < width < wanted:
                yield f"the cell {text!r} does not fit into {width} px, it takes {wanted} px"


def _has_something_to_read(widget: QWidget) -> bool:
    return isinstance(widget, (QLabel, QAbstractButton, QComboBox, QLineEdit)) and bool(_text(widget))


def _scrolls(widget: QWidget) -> bool:
    parent = widget.parentWidget()
    if parent is None:
        return False
    return isinstance(parent, QAbstractScrollArea) or _scrolls(parent)


def _text(widget: QWidget) -> str:
    if isinstance(widget, QComboBox):
        return widget.currentText()
    if isinstance(widget, QTabBar):
        return ", ".join(widget.tabText(number) for number in range(widget.count()))
    if isinstance(widget, QLineEdit):
        return widget.displayText() or widget.placeholderText()
    text = getattr(widget, "text", None)
    return str(text()) if callable(text) else ""


def _name(widget: QWidget) -> str:
    if widget.objectName() and not widget.objectName().startswith("qt_"):
        return widget.objectName()
    parent = widget.parentWidget()
    kind = type(widget).__name__
    return f"{kind} in {_name(parent)}" if parent is not None else kind


def _size(size: QSize) -> str:
    return f"{size.width()} × {size.height()}"
