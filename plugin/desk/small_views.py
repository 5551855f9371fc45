"""Tables that have to fit into a narrow and low panel."""

from __future__ import annotations

from qgis.PyQt.QtWidgets import QAbstractItemView, QHeaderView

LOWEST = 44
"""Pixels that a table keeps on a low screen: its head and a row or two."""


def shrink(view: QAbstractItemView) -> None:
    """Take a size less for the cells and headers of a table in a narrow panel, and let it be low."""
    view.setMinimumHeight(LOWEST)
    font = view.font()
    font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
    view.setFont(font)
    for header in view.findChildren(QHeaderView):
        header.setFont(font)
