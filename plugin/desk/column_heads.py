"""Columns that are as wide as their heads need in the language of QGIS."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QHeaderView, QStyle, QTableView, QTreeView

EDGES = 4
"""Pixels beside a head's words."""


def fit_heads(view: QTableView | QTreeView) -> None:
    """Widen each column whose head would be cut off, now and when it gets the mark of sorting.

    None becomes narrower. The heads of ``view`` have their font and their columns' first widths already.
    """
    header = _heads(view)
    for column in range(header.count()):
        _fit(header, column)
    # No function that holds the header itself: nothing else in Python would, so that Python took both for
    # garbage, and the next click on a head crashed QGIS.
    header.sortIndicatorChanged.connect(lambda column, _order: _fit(_heads(view), column))


def _heads(view: QTableView | QTreeView) -> QHeaderView:
    return view.header() if isinstance(view, QTreeView) else view.horizontalHeader()


def _fit(header: QHeaderView, column: int) -> None:
    if column < 0 or header.isSectionHidden(column):
        return
    head = header.model().headerData(column, Qt.Orientation.Horizontal, Qt.ItemDataRole.DisplayRole)
    wanted = header.fontMetrics().horizontalAdvance(str(head or "")) + 2 * EDGES
    if header.isSortIndicatorShown() and header.sortIndicatorSection() == column:
        wanted += header.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMarkSize, None, header)
    header.resizeSection(column, max(header.sectionSize(column), wanted))
