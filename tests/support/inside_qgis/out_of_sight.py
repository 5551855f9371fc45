"""Finds what an operator at the real window cannot read or reach: cut off, covered, beyond the screen."""

from __future__ import annotations

from collections.abc import Iterator

from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAbstractScrollArea,
    QApplication,
    QComboBox,
    QHeaderView,
    QLabel,
    QStyle,
    QTableView,
    QWidget,
)
from qgis.utils import iface

from tests.support.inside_qgis.cut_off import cut_off

OURS = "fleet_"
SLACK = 1
"""Pixels that styles round by."""


def what_is_out_of_sight() -> list[str]:
    """Return what is wrong with the window and each visible part of the plugin; an empty list for nothing."""
    found = [*_beyond_the_screen(iface.mainWindow())]
    for top in filter(_is_top, QApplication.allWidgets()):
        found += cut_off(top)
        for part in [top, *top.findChildren(QWidget)]:
            found += [f"{_name(part)}: {fault}" for fault in _faults(part)]
    return found


def _is_top(widget: QWidget) -> bool:
    return widget.objectName().startswith(OURS) and widget.isVisible() and not _is_inside_ours(widget)


def _is_inside_ours(widget: QWidget) -> bool:
    parent = widget.parentWidget()
    return parent is not None and (parent.objectName().startswith(OURS) or _is_inside_ours(parent))


def _faults(part: QWidget) -> Iterator[str]:
    if not part.isVisible():
        return
    if isinstance(part, QTableView):
        yield from _cut_cells(part)
    if isinstance(part, (QLabel, QAbstractButton, QComboBox)) and not _scrolls(part):
        seen = part.visibleRegion().boundingRect().size()
        if seen.width() < part.width() - SLACK or seen.height() < part.height() - SLACK:
            yield f"only {_size(seen)} of its {_size(part.size())} pixels are seen"


def _beyond_the_screen(window: QWidget) -> Iterator[str]:
    screen = QApplication.primaryScreen().geometry()
    if not screen.contains(window.frameGeometry()):
        yield f"the window is {_size(window.size())}, beyond the screen of {_size(screen.size())}"


def _cut_cells(table: QTableView) -> Iterator[str]:
    model = table.model()
    beside = 2 * (table.style().pixelMetric(QStyle.PixelMetric.PM_FocusFrameHMargin) + 1)
    for row in range(model.rowCount()):
        for column in range(model.columnCount()):
            index, width = model.index(row, column), table.columnWidth(column)
            text = str(index.data() or "")
            if _gives_way(table, column) and text in str(index.data(Qt.ItemDataRole.ToolTipRole) or ""):
                continue
            wanted = table.fontMetrics().horizontalAdvance(text) + beside if text else 0
            if index.data(Qt.ItemDataRole.DecorationRole) is not None:
                wanted += table.style().pixelMetric(QStyle.PixelMetric.PM_SmallIconSize) + beside
            if 0 < width < wanted:
                yield f"the cell {text!r} does not fit into {width} px, it takes {wanted} px"


def _gives_way(table: QTableView, column: int) -> bool:
    """Tell whether a column takes what the others leave; what it cuts its tool tip has to say."""
    return table.horizontalHeader().sectionResizeMode(column) == QHeaderView.ResizeMode.Stretch


def _scrolls(widget: QWidget) -> bool:
    parent = widget.parentWidget()
    if parent is None:
        return False
    return isinstance(parent, QAbstractScrollArea) or _scrolls(parent)


def _name(widget: QWidget) -> str:
    if widget.objectName() and not widget.objectName().startswith("qt_"):
        return widget.objectName()
    parent = widget.parentWidget()
    kind = type(widget).__name__
    return f"{kind} in {_name(parent)}" if parent is not None else kind


def _size(size: QSize) -> str:
    return f"{size.width()} × {size.height()}"
