"""The table of placed cones in a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime, timezone

from qgis.core import (
    QgsLayoutFrame,
    QgsLayoutItemTextTable,
    QgsLayoutMultiFrame,
    QgsLayoutTable,
    QgsLayoutTableColumn,
    QgsPrintLayout,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor

from ..language import tr
from .column_room import shared, shortened
from .placed_cones import PlacedCone
from .report_items import MARGIN, TEXT_WIDTH, a4_page, put, text_format, widths_of

COLUMNS = (
    (tr("Cone"), 22, False),
    (tr("Layout"), 20, False),
    (tr("Robot"), 16, False),
    (tr("Placed (UTC)"), 31, False),
    (tr("Planned E"), 20, True),
    (tr("Planned N"), 21, True),
    (tr("ΔE cm"), 10, True),
    (tr("ΔN cm"), 10, True),
    (tr("Off cm"), 11, True),
    ("", 3, False),
)
"""Of each its head, its width in millimetres without the margins of its cells, and whether it has numbers."""
NAMES = 3
"""Columns of names, the first ones: they share their room as their names are long."""
LETTERS = 7.5
"""Points."""
BEYOND = "!"
"""Stands beside a cone that is beyond the tolerance."""


def add_table(layout: QgsPrintLayout, cones: Sequence[PlacedCone], tolerance: float) -> None:
    """Put the table on the second page, and on as many more as it takes, each with its heads."""
    table = QgsLayoutItemTextTable(layout)
    layout.addMultiFrame(table)
    head = text_format(LETTERS, bold=True)
    table.setHeaderTextFormat(head)
    table.setContentTextFormat(text_format(LETTERS, bold=False))
    # Bold letters are the wider ones: what fits in them fits.
    _fill(table, [_row(cone, tolerance) for cone in cones], widths_of(layout, head))
    table.setHeaderMode(QgsLayoutTable.HeaderMode.AllFrames)
    table.setCellMargin(0.7)
    table.setGridStrokeWidth(0.1)
    table.setGridColor(QColor(173, 181, 189))
    layout.pageCollection().addPage(a4_page(layout))
    frame = QgsLayoutFrame(layout, table)
    put(frame, (MARGIN, MARGIN, TEXT_WIDTH, 264), page=1)
    table.addFrame(frame)
    table.setResizeMode(QgsLayoutMultiFrame.ResizeMode.RepeatUntilFinished)
    table.recalculateFrameSizes()


def _fill(table: QgsLayoutItemTextTable, rows: Sequence[list[str]], width_of: Callable[[str], float]) -> None:
    """Give the table its rows, and columns in which the names fit as far as there is room."""
    heads, widths, numbers = zip(*COLUMNS, strict=True)
    texts = [{head, *(row[k] for row in rows)} for k, head in enumerate(heads[:NAMES])]
    room = shared(sum(widths[:NAMES]), [max(map(width_of, column)) for column in texts])
    fitting = [
        {text: shortened(text, width, width_of) for text in column}
        for column, width in zip(texts, room, strict=True)
    ]
    for row in rows:
        row[:NAMES] = [short[text] for short, text in zip(fitting, row[:NAMES], strict=True)]
    columns = zip(heads, [*room, *widths[NAMES:]], numbers, strict=True)
    table.setColumns([_column(*column) for column in columns])
    table.setContents(rows)


def _column(head: str, width: float, numbers: bool) -> QgsLayoutTableColumn:
    column = QgsLayoutTableColumn()
    column.setHeading(head)
    column.setWidth(width)
    column.setHAlignment(Qt.AlignmentFlag.AlignRight if numbers else Qt.AlignmentFlag.AlignLeft)
    return column


def _row(cone: PlacedCone, tolerance: float) -> list[str]:
    (east, north), (x, y) = cone.off, cone.planned
    return [
        cone.name,
        cone.layout,
        cone.robot,
        "" if cone.at is None else time_in_words(cone.at),
        f"{x:.2f}",
        f"{y:.2f}",
        f"{east * 100:+.1f}",
        f"{north * 100:+.1f}",
        f"{cone.deviation * 100:.1f}",
        BEYOND if cone.deviation > tolerance else "",
    ]


def time_in_words(at: float) -> str:
    """Return seconds since 1970 as a time in UTC."""
    return datetime.fromtimestamp(at, timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
