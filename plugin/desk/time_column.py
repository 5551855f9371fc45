"""A column of times that is as wide as its widest time."""

from __future__ import annotations

from qgis.PyQt.QtWidgets import QTableView, QTreeView

from .wall_clock import short_time

TODAY = "00:00:00"


class TimeColumn:
    """The first column of ``view``, with ``beside`` pixels around a time; what the user drags it to stays."""

    def __init__(self, view: QTableView | QTreeView, beside: int):
        self._view, self._beside = view, beside
        self._letters = 0
        self.make_room(None)

    def make_room(self, oldest: float | None) -> None:
        """Have room for times from ``oldest`` on, seconds since 1970: another day's have their date."""
        widest = max(TODAY, short_time(oldest), key=len)
        if len(widest) != self._letters:
            self._letters = len(widest)
            self._view.setColumnWidth(0, self._view.fontMetrics().horizontalAdvance(widest) + self._beside)
