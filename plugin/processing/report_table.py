"""The table of placed cones in a report."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timezone

from qgis.core import (
    QgsLayoutFrame,
    QgsLayoutItemTextTable,
    QgsLayoutMultiFrame,
    QgsLayoutTableColumn,
    QgsPrintLayout,
)
from qgis.PyQt.QtCore import Qt

from ..language import tr
from .placed_cones import PlacedCone
from .report_items import MARGIN, TEXT_WIDTH, a4_page, put, text_format

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


def add_table(layout: QgsPrintLayout, cones: Sequence[PlacedCone], tolerance: float) -> None:
    """Put the table on the second page, and on as many more as it takes."""
    table = QgsLayoutItemTextTable(layout)
    layout.addMultiFrame(table)
    table.setColumns([_column(*column) for column in COLUMNS])
    table.setContents([_row(cone, tolerance) for cone in cones])
    for set_format, size, bold in (
        (table.setContentTextFormat, 7.5, False),
        (table.setHeaderTextFormat, 7.5, True),
    ):
        set_format(text_format(size, bold=bold))
    table.setCellMargin(0.7)
    table.setGridStrokeWidth(0.1)
    layout.pageCollection().addPage(a4_page(layout))
    frame = QgsLayoutFrame(layout, table)
    put(frame, (MARGIN, MARGIN, TEXT_WIDTH, 266), page=1)
    table.addFrame(frame)
    table.setResizeMode(QgsLayoutMultiFrame.ResizeMode.RepeatUntilFinished)
    table.recalculateFrameSizes()


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
        "!" if cone.deviation > tolerance else "",
    ]


def time_in_words(at: float) -> str:
    """Return seconds since 1970 as a time in UTC."""
    return datetime.fromtimestamp(at, timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
