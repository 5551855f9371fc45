"""Columns that are as wide as their heads need in the language of QGIS."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QHeaderView, QStyle

EDGES = 6
"""Pixels beside a head's words."""


def fit_heads(header: QHeaderView) -> None:
    """Widen each column whose head would be cut off; none becomes narrower.

    ``header`` lies across the top of its table and has its font and its columns' first widths already.
    """
    sorting = 0
    if header.isSortIndicatorShown():
        sorting = header.style().pixelMetric(QStyle.PixelMetric.PM_HeaderMarkSize, None, header)
    for column in range(header.count()):
        head = header.model().headerData(column, Qt.Orientation.Horizontal, Qt.ItemDataRole.DisplayRole)
        words = header.fontMetrics().horizontalAdvance(str(head or ""))
        if not header.isSectionHidden(column):
            header.resizeSection(column, max(header.sectionSize(column), words + 2 * EDGES + sorting))
