from __future__ import annotations

import gc

from fleet_supervisor.plugin.ui.tables import fit_headers
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QTableWidget


def table_with_narrow_heads() -> QTableWidget:
    table = QTableWidget(1, 2)
    table.setHorizontalHeaderLabels(["Battery", "Last message of the robot"])
    table.setSortingEnabled(True)
    fit_headers(table)
    return table


def widened_by_sorting(table: QTableWidget, column: int) -> int:
    """Sort by ``column`` and return by how many pixels that has widened it."""
    before = table.columnWidth(column)
    table.sortByColumn(column, Qt.SortOrder.AscendingOrder)
    return table.columnWidth(column) - before


def test_a_column_gets_room_for_the_mark_of_sorting(qgis_app):
    assert widened_by_sorting(table_with_narrow_heads(), 1) > 0


def test_a_column_gets_that_room_after_python_has_collected_its_garbage(qgis_app):
    table = table_with_narrow_heads()
    gc.collect()
    assert widened_by_sorting(table, 1) > 0
