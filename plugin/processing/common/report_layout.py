"""Pages of the as-placed report: print layout, table, PDF."""

from __future__ import annotations

import re
import tempfile
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsAbstractLayoutIterator,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsLayoutExporter,
    QgsLayoutFrame,
    QgsLayoutItem,
    QgsLayoutItemLabel,
    QgsLayoutItemMap,
    QgsLayoutItemPage,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLayoutItemTextTable,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLayoutTable,
    QgsLayoutTableColumn,
    QgsLayoutUtils,
    QgsMapLayer,
    QgsPrintLayout,
    QgsProcessingFeedback,
    QgsProject,
    QgsTextFormat,
    QgsTextRenderer,
    QgsUnitTypes,
)
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QColor

from ...ui.language import tr, tr_count
from . import placed_cones
from .outputs import OutputError, check_target, write_whole

# --- Widths of texts in the columns of a table: shared out, and texts shortened in the middle


def shared_widths(room: float, needs: Sequence[float]) -> list[float]:
    """Return ``room`` shared out: each gets its need or an equal share, and the neediest the rest."""
    given = [0.0] * len(needs)
    order = sorted(range(len(needs)), key=needs.__getitem__)
    for done, each in enumerate(order):
        given[each] = min(needs[each], room / (len(needs) - done))
        room -= given[each]
    given[order[-1]] += room
    return given


def shortened(text: str, room: float, width_of: Callable[[str], float]) -> str:
    """Return ``text`` fitted into ``room``, by ``width_of``: its end, often a number, distinguishes it."""
    if width_of(text) <= room:
        return text
    for kept in range(len(text) - 1, 1, -1):
        end = text[len(text) - kept // 2 :]
        short = f"{text[: kept - len(end)]}…{end}"
        if width_of(short) <= room:
            return short
    return "…"


# --- Texts, positions and pages of a report, in millimetres ---

PAGE = (210.0, 297.0)
"""Millimetres, as everything here."""
MARGIN = 15.0
TEXT_WIDTH = PAGE[0] - 2 * MARGIN
TABLE_HEIGHT = 264.0


def a4_page(project: QgsProject) -> QgsPrintLayout:
    """Return a layout of one page, upright."""
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.pageCollection().page(0).setPageSize("A4", QgsLayoutItemPage.Orientation.Portrait)
    return layout


def add_text(
    layout: QgsPrintLayout,
    text: str,
    area: tuple[float, float, float, float],
    size: float,
    *,
    bold: bool = False,
) -> QgsLayoutItemLabel:
    """Add ``text`` in letters of ``size`` points, return its label; ``area`` as for :func:`place_item`."""
    label = QgsLayoutItemLabel(layout)
    label.setText(text)
    letters = text_format(size, bold=bold)
    if hasattr(label, "setTextFormat"):
        label.setTextFormat(letters)
    else:
        # QGIS 3.22.
        label.setFont(letters.toQFont())
    place_item(label, area)
    layout.addLayoutItem(label)
    return label


def text_format(size: float, *, bold: bool) -> QgsTextFormat:
    """Return letters of ``size`` points."""
    letters = QgsTextFormat()
    font = letters.font()
    font.setFamily("Sans Serif")
    font.setBold(bold)
    letters.setFont(font)
    letters.setSize(size)
    letters.setSizeUnit(QgsUnitTypes.RenderUnit.RenderPoints)
    return letters


def widths_of(layout: QgsPrintLayout, letters: QgsTextFormat) -> Callable[[str], float]:
    """Return a function for the width of a text in ``letters``, in millimetres."""
    context = QgsLayoutUtils.createRenderContextForLayout(layout, None)
    millimetre = context.convertToPainterUnits(1.0, QgsUnitTypes.RenderUnit.RenderMillimeters)
    return lambda text: QgsTextRenderer.textWidth(context, letters, [text]) / millimetre


def place_item(item: QgsLayoutItem, area: tuple[float, float, float, float]) -> None:
    """Put ``item`` into ``area`` of the page: left, top, width, height."""
    left, top, width, height = area
    item.attemptResize(QgsLayoutSize(width, height, QgsUnitTypes.LayoutUnit.LayoutMillimeters))
    item.attemptMove(corner(left, top))


def corner(left: float, top: float) -> QgsLayoutPoint:
    """Return a place on a page."""
    return QgsLayoutPoint(left, top, QgsUnitTypes.LayoutUnit.LayoutMillimeters)


# --- The table of placed cones in a report ---

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
"""Of each its head, its width in millimetres without the margins of its cells, and whether it is numeric."""
NAMES = 3
"""Columns of names, the first ones: they share their room in proportion to their names."""
LETTERS = 7.5
"""Points."""
MOST_ROWS = 200
"""Rows that certainly do not fit on a page."""
BEYOND = "!"
"""Mark of a cone that is beyond the tolerance."""


class ReportTable:
    """The rows and columns of the table, made page by page in layouts of their own.

    One table over all pages would be laid out again for each of them: 24 s for 5 000 cones.
    """

    def __init__(self, cones: Sequence[placed_cones.PlacedCone], tolerance: float, project: QgsProject):
        self._head = text_format(LETTERS, bold=True)
        rows = [_row(cone, tolerance) for cone in cones]
        layout = a4_page(project)
        # Bold letters are wider: a text that fits in bold fits.
        self._columns = _fitted(rows, widths_of(layout, self._head))
        # What QGIS would go on with in a second frame is too much for a page.
        at_once = -1 + bisect_right(
            range(MOST_ROWS),
            TABLE_HEIGHT + 1,
            lo=1,
            key=lambda count: self._add(layout, rows[:1] * count).totalSize().height(),
        )
        self.pages = [rows[k : k + at_once] for k in range(0, len(rows), at_once)]
        """The rows of each page."""

    def add_to(self, layout: QgsPrintLayout, number: int) -> None:
        """Put the rows of that page, from 0, on the page of ``layout``, with the heads."""
        self._add(layout, self.pages[number])

    def _add(self, layout: QgsPrintLayout, rows: Sequence[list[str]]) -> QgsLayoutItemTextTable:
        table = QgsLayoutItemTextTable(layout)
        layout.addMultiFrame(table)
        table.setHeaderTextFormat(self._head)
        table.setContentTextFormat(text_format(LETTERS, bold=False))
        table.setHeaderMode(QgsLayoutTable.HeaderMode.AllFrames)
        table.setCellMargin(0.7)
        table.setGridStrokeWidth(0.1)
        table.setGridColor(QColor(173, 181, 189))
        table.setColumns([_column(*column) for column in self._columns])
        table.setContents(rows)
        frame = QgsLayoutFrame(layout, table)
        place_item(frame, (MARGIN, MARGIN, TEXT_WIDTH, TABLE_HEIGHT))
        table.addFrame(frame)
        return table


def _fitted(rows: Sequence[list[str]], width_of: Callable[[str], float]) -> list[tuple[str, float, bool]]:
    """Return the columns, fitted to the names as far as there is room; names in ``rows`` are shortened."""
    heads, widths, numbers = zip(*COLUMNS, strict=True)
    texts = [{head, *(row[k] for row in rows)} for k, head in enumerate(heads[:NAMES])]
    room = shared_widths(sum(widths[:NAMES]), [max(map(width_of, column)) for column in texts])
    fitting = [
        {text: shortened(text, width, width_of) for text in column}
        for column, width in zip(texts, room, strict=True)
    ]
    for row in rows:
        row[:NAMES] = [short[text] for short, text in zip(fitting, row[:NAMES], strict=True)]
    return list(zip(heads, [*room, *widths[NAMES:]], numbers, strict=True))


def _column(head: str, width: float, numbers: bool) -> QgsLayoutTableColumn:
    column = QgsLayoutTableColumn()
    column.setHeading(head)
    column.setWidth(width)
    column.setHAlignment(Qt.AlignmentFlag.AlignRight if numbers else Qt.AlignmentFlag.AlignLeft)
    return column


def _row(cone: placed_cones.PlacedCone, tolerance: float) -> list[str]:
    (east, north), (x, y) = cone.off, cone.planned
    # In one line each: all rows are of one height.
    return [
        *(" ".join(name.split()) for name in (cone.name, cone.layout, cone.robot)),
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


# --- The as-placed report as a print layout of A4 pages, and as PDF ---


@dataclass(frozen=True)
class ReportContent:
    """The content of the report: ``cones`` in the table's order, ``background`` from the top."""

    title: str
    cones: Sequence[placed_cones.PlacedCone]
    figures: placed_cones.ConeDeviations
    tolerance: float
    crs: QgsCoordinateReferenceSystem
    background: Sequence[QgsMapLayer] = field(default_factory=tuple)


def write_pdf(
    report: ReportContent,
    file: Path,
    transforms: QgsCoordinateTransformContext,
    feedback: QgsProcessingFeedback,
) -> int | None:
    """Write ``file``, completely or not at all, and return its number of pages; None if cancelled.

    :raises OutputError: when it cannot be written.
    """
    check_target(file, tr("The report"))
    # In a separate project, so that nothing is left in the user's.
    project = QgsProject()
    project.setCrs(report.crs)
    project.setTransformContext(transforms)
    with tempfile.TemporaryDirectory(prefix="fleet-report-") as folder:
        pages = ReportPages(report, project, Path(folder))
        part = Path(folder) / "report.pdf"
        settings = QgsLayoutExporter.PdfExportSettings()
        # As text and not as outlines of letters: a report is searched and copied from.
        settings.textRenderFormat = Qgis.TextRenderFormat.AlwaysText
        # It says its progress before each page: QGIS's dialog handles events then, F10 and Cancel among them.
        done, why = QgsLayoutExporter.exportToPdf(pages, str(part), settings, feedback)
        if feedback.isCanceled():
            return None
        if done != QgsLayoutExporter.ExportResult.Success:
            raise OutputError(
                tr(
                    "QGIS cannot make the report (layout export {number}): check the free space, and the "
                    "background layers by leaving them out.",
                    number=why or int(done),
                )
            )
        write_whole(file, part.read_bytes(), tr("The report"))
    return pages.count()


class ReportPages(QgsAbstractLayoutIterator):
    """The pages of the report for QGIS's export, each a layout that is made when its turn comes.

    The pictures of the first one are in ``folder`` until it is exported.
    """

    def __init__(self, report: ReportContent, project: QgsProject, folder: Path) -> None:
        super().__init__()
        self._report, self._project, self._folder = report, project, folder
        self._table = ReportTable(report.cones, report.tolerance, project)
        self._number = -1
        self._layout: QgsPrintLayout | None = None

    def beginRender(self):
        return True

    def endRender(self):
        return True

    def count(self):
        return 1 + len(self._table.pages)

    def filePath(self, base: str, extension: str):
        return f"{base}.{extension}"

    def next(self):
        self._number += 1
        if self._number == self.count():
            return False
        self._layout = a4_page(self._project)
        if self._number:
            self._table.add_to(self._layout, self._number - 1)
            add_text(self._layout, _key(self._report), (MARGIN, 282, TEXT_WIDTH, 5), 8)
        else:
            _first_page(self._layout, self._report, self._project, self._folder)
        text = f"{self._report.title} · {self._number + 1} / {self.count()}"
        label = add_text(self._layout, text, (MARGIN, 287, TEXT_WIDTH, 5), 8)
        label.setHAlign(Qt.AlignmentFlag.AlignRight)
        return True

    def layout(self):
        return self._layout


def _first_page(layout: QgsPrintLayout, report: ReportContent, project: QgsProject, folder: Path) -> None:
    add_text(layout, report.title, (MARGIN, 12, TEXT_WIDTH, 10), 17, bold=True)
    add_text(layout, _summary(report), (MARGIN, 22, TEXT_WIDTH, 20), 9.5)
    _picture(layout, report, folder)
    _map(layout, report, project)


def _key(report: ReportContent) -> str:
    """Return the explanation of the table's columns."""
    return tr(
        "E and N in metres of {crs}; {mark} beyond the tolerance of {tolerance:g} cm",
        crs=report.crs.authid() or report.crs.description(),
        mark=BEYOND,
        tolerance=report.tolerance * 100,
    )


def _summary(report: ReportContent) -> str:
    figures = report.figures
    lines = [
        tr_count(
            figures.count,
            "{within} of 1 cone ({share:.0f} %) stands within {tolerance:g} cm of its plan.",
            "{within} of %n cones ({share:.0f} %) stand within {tolerance:g} cm of their plan.",
            within=figures.within,
            share=100.0 * figures.within / figures.count,
            tolerance=report.tolerance * 100,
        ),
        tr(
            "Mean {mean}, RMS {rms}, 95 % within {p95}, largest {most}.",
            mean=_length(figures.mean),
            rms=_length(figures.rms),
            p95=_length(figures.p95),
            most=_length(figures.most),
        ),
        "; ".join([*_times(report), report.crs.userFriendlyIdentifier()]),
    ]
    robots = sorted({cone.robot for cone in report.cones if cone.robot}, key=_natural)
    if robots:
        names = ", ".join(robots[:8]) + (" …" if len(robots) > 8 else "")
        lines.insert(2, tr("Robots: {names}", names=names))
    return "\n".join(lines)


def _times(report: ReportContent) -> list[str]:
    """Return when the first and the last cone were placed; empty where that is not known."""
    times = [cone.at for cone in report.cones if cone.at is not None]
    if not times:
        return []
    first, last = time_in_words(min(times)), time_in_words(max(times))
    if first == last:
        return [tr("{time} UTC", time=first)]
    if first[:10] == last[:10]:
        last = last[11:]
    return [tr("{first} to {last} UTC", first=first, last=last)]


def _natural(name: str) -> list[tuple[int, str]]:
    """Return a key that sorts names by the numbers in them: r2 comes before r10."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", name)]


def _picture(layout: QgsPrintLayout, report: ReportContent, folder: Path) -> None:
    file = folder / "histogram.svg"
    file.write_text(
        placed_cones.histogram(placed_cones.deviation_values(report.cones), report.tolerance),
        encoding="utf-8",
    )
    picture = QgsLayoutItemPicture(layout)
    picture.setPicturePath(str(file))
    place_item(picture, (MARGIN, 42, TEXT_WIDTH, TEXT_WIDTH * placed_cones.HEIGHT / placed_cones.WIDTH))
    layout.addLayoutItem(picture)


def _map(layout: QgsPrintLayout, report: ReportContent, project: QgsProject) -> None:
    top = 42 + TEXT_WIDTH * placed_cones.HEIGHT / placed_cones.WIDTH + 4
    shown = QgsLayoutItemMap(layout)
    place_item(shown, (MARGIN, top, TEXT_WIDTH, 274 - top))
    shown.setFrameEnabled(True)
    shown.setCrs(report.crs)
    shown.zoomToExtent(placed_cones.extent_of(report.cones))
    factor = placed_cones.factor_of(report.cones, shown.extent().width())
    layers = placed_cones.map_layers(report.cones, report.crs, report.tolerance, factor)
    project.addMapLayers(layers, False)
    shown.setLayers([*layers, *report.background])
    shown.setKeepLayerSet(True)
    layout.addLayoutItem(shown)
    bar = QgsLayoutItemScaleBar(layout)
    bar.setStyle("Line Ticks Up")
    bar.setLinkedMap(shown)
    bar.setUnits(QgsUnitTypes.DistanceUnit.DistanceMeters)
    bar.applyDefaultSize()
    bar.setUnits(QgsUnitTypes.DistanceUnit.DistanceMeters)
    bar.setUnitLabel("m")
    bar.setMapUnitsPerScaleBarUnit(1.0)
    bar.setBackgroundEnabled(True)
    bar.setTextFormat(text_format(8, bold=False))
    bar.setHeight(2.0)
    bar.resizeToMinimumWidth()
    bar.setReferencePoint(QgsLayoutItem.ReferencePoint.LowerLeft)
    bar.attemptMove(corner(MARGIN + 2, 272))
    layout.addLayoutItem(bar)
    words = (
        tr("× planned   ● placed (red: beyond the tolerance)   orange: deviation")
        if factor == 1
        else tr(
            "× planned   ● placed (red: beyond the tolerance)   orange: deviation, {factor} times as long",
            factor=factor,
        )
    )
    add_text(layout, words, (MARGIN, 275.5, TEXT_WIDTH, 6), 8)


def _length(metres: float) -> str:
    return f"{metres:.2f} m" if metres >= 1.0 else f"{metres * 100:.1f} cm"
