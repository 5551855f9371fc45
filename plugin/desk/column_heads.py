"""Columns that are as wide as their heads need in the language of QGIS."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QHeaderView, QStyle

EDGES = 4
"""Pixels beside a head's words."""


def fit_heads(header: QHeaderView) -> None:
    """Widen each column whose head would be cut off, now and when it gets the mark of sorting.

    None becomes narrower. ``header`` lies across the top of its table and has its font and its columns'
    first widths already.
    """
    for column in range(header.count()):
        _fit(header, column)
    header.sortIndicatorChanged.connect(lambda column, _order: _fit(header, column))


def _fit(header: QHeaderView, column: int) -> None:
    if column < 0 or header.isSectionHidden(column):
        return
    head = header.model().headerData(column, Qt.Orientation.Horizontal, Qt.ItemDataRole.DisplayRole)
    wanted = header.fontMetrics().horizontalAdvance(str(head or "")) + 2 * EDGES
    if header.isSortIndicatorShown() and header.sortIndicatorSection() == column:
        wanted += header.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMarkSize, None, header)
    header.resizeSection(column, max(header.sectionSize(column), wanted))
