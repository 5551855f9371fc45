"""The as-placed report as a print layout of A4 pages, and as PDF."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsLayoutExporter,
    QgsLayoutItem,
    QgsLayoutItemMap,
    QgsLayoutItemPage,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsMapLayer,
    QgsPrintLayout,
    QgsProcessingFeedback,
    QgsProject,
    QgsUnitTypes,
)
from qgis.PyQt.QtCore import Qt

from ..language import tr, tr_count
from .histogram_svg import HEIGHT, WIDTH, histogram
from .placed_cones import Deviations, PlacedCone, values_of
from .report_items import MARGIN, TEXT_WIDTH, add_text, corner, put, text_format
from .report_layers import extent_of, factor_of, map_layers
from .report_table import BEYOND, add_table, time_in_words
from .whole_file import OutputError, check_target, write_whole


@dataclass(frozen=True)
class Report:
    """What is to be told: ``cones`` in the table's order, ``background`` from the top."""

    title: str
    cones: Sequence[PlacedCone]
    figures: Deviations
    tolerance: float
    crs: QgsCoordinateReferenceSystem
    background: Sequence[QgsMapLayer] = field(default_factory=tuple)


def write_pdf(
    report: Report, file: Path, transforms: QgsCoordinateTransformContext, feedback: QgsProcessingFeedback
) -> int | None:
    """Write ``file``, whole or not at all, and return its number of pages; None when cancelled.

    :raises OutputError: when it cannot be written.
    """
    check_target(file, tr("The report"))
    # A project of its own, so that nothing is left in the user's.
    project = QgsProject()
    project.setCrs(report.crs)
    project.setTransformContext(transforms)
    with tempfile.TemporaryDirectory(prefix="fleet-report-") as folder:
        layout = laid_out(report, project, Path(folder))
        feedback.setProgress(40)
        if feedback.isCanceled():
            return None
        part = Path(folder) / "report.pdf"
        settings = QgsLayoutExporter.PdfExportSettings()
        # As text and not as drawings of letters: a report is searched and copied from.
        settings.textRenderFormat = Qgis.TextRenderFormat.AlwaysText
        done = QgsLayoutExporter(layout).exportToPdf(str(part), settings)
        if done != QgsLayoutExporter.ExportResult.Success:
            raise OutputError(
                tr(
                    "QGIS cannot make the report (layout export {number}): check the free space, and the "
                    "background layers by leaving them out.",
                    number=int(done),
                )
            )
        pages = layout.pageCollection().pageCount()
        write_whole(file, part.read_bytes(), tr("The report"))
    return pages


def laid_out(report: Report, project: QgsProject, folder: Path) -> QgsPrintLayout:
    """Return the layout in ``project``; its pictures are in ``folder`` until it is exported."""
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.pageCollection().page(0).setPageSize("A4", QgsLayoutItemPage.Orientation.Portrait)
    add_text(layout, report.title, (MARGIN, 12, TEXT_WIDTH, 10), 17, bold=True)
    add_text(layout, _told(report), (MARGIN, 22, TEXT_WIDTH, 20), 9.5)
    _picture(layout, report, folder)
    _map(layout, report, project)
    add_table(layout, report.cones, report.tolerance)
    _feet(layout, report)
    return layout


def _feet(layout: QgsPrintLayout, report: Report) -> None:
    """Number the pages, and say on those of the table what its columns are."""
    key = tr(
        "E and N in metres of {crs}; {mark} beyond the tolerance of {tolerance:g} cm",
        crs=report.crs.authid() or report.crs.description(),
        mark=BEYOND,
        tolerance=report.tolerance * 100,
    )
    count = layout.pageCollection().pageCount()
    for page in range(count):
        if page:
            add_text(layout, key, (MARGIN, 282, TEXT_WIDTH, 5), 8, page=page)
        text = f"{report.title} · {page + 1} / {count}"
        label = add_text(layout, text, (MARGIN, 287, TEXT_WIDTH, 5), 8, page=page)
        label.setHAlign(Qt.AlignmentFlag.AlignRight)


def _told(report: Report) -> str:
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


def _times(report: Report) -> list[str]:
    """Return when the first and the last cone were placed; nothing where that is not known."""
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
    """Return what sorts names by the numbers in them: r2 comes before r10."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", name)]


def _picture(layout: QgsPrintLayout, report: Report, folder: Path) -> None:
    file = folder / "histogram.svg"
    file.write_text(histogram(values_of(report.cones), report.tolerance), encoding="utf-8")
    picture = QgsLayoutItemPicture(layout)
    picture.setPicturePath(str(file))
    put(picture, (MARGIN, 42, TEXT_WIDTH, TEXT_WIDTH * HEIGHT / WIDTH))
    layout.addLayoutItem(picture)


def _map(layout: QgsPrintLayout, report: Report, project: QgsProject) -> None:
    top = 42 + TEXT_WIDTH * HEIGHT / WIDTH + 4
    shown = QgsLayoutItemMap(layout)
    put(shown, (MARGIN, top, TEXT_WIDTH, 274 - top))
    shown.setFrameEnabled(True)
    shown.setCrs(report.crs)
    shown.zoomToExtent(extent_of(report.cones))
    factor = factor_of(report.cones, shown.extent().width())
    layers = map_layers(report.cones, report.crs, report.tolerance, factor)
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
