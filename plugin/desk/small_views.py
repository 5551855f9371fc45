"""Tables that have to fit into a narrow panel."""

from __future__ import annotations

from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView


def shrink(view: QAbstractItemView) -> None:
    """Take a size less for the cells and headers of a table in a narrow panel."""
    font = view.font()
    font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
    view.setFont(font)
    for header in view.findChildren(QHeaderView):
        header.setFont(font)
