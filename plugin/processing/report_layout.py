"""The as-placed report as a print layout of A4 pages, and as PDF."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransformContext,
    QgsLayoutExporter,
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

from ..language import tr
from .histogram_svg import HEIGHT, WIDTH, histogram
from .placed_cones import Deviations, PlacedCone, values_of
from .report_items import MARGIN, TEXT_WIDTH, add_text, corner, put
from .report_layers import extent_of, factor_of, map_layers
from .report_table import add_table, time_in_words
from .whole_file import OutputError


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
    if not file.parent.is_dir():
        raise OutputError(
            tr(
                "The report cannot be written to {file}: there is no folder {folder}.",
                file=file,
                folder=file.parent,
            )
        )
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
        _put(part, file)
    return pages


def _put(part: Path, file: Path) -> None:
    beside = file.with_name(f".{file.name}.part")
    try:
        beside.write_bytes(part.read_bytes())
        beside.replace(file)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise OutputError(
            tr(
                "The report cannot be written to {file}: {error}. Close it if a program shows it, or choose "
                "another file.",
                file=file,
                error=error.strerror or error,
            )
        ) from error


def laid_out(report: Report, project: QgsProject, folder: Path) -> QgsPrintLayout:
    """Return the layout in ``project``; its pictures are in ``folder`` until it is exported."""
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.pageCollection().page(0).setPageSize("A4", QgsLayoutItemPage.Orientation.Portrait)
    add_text(layout, report.title, (MARGIN, 12, TEXT_WIDTH, 10), 17, bold=True)
    add_text(layout, _told(report), (MARGIN, 23, TEXT_WIDTH, 16), 10)
    _picture(layout, report, folder)
    _map(layout, report, project)
    add_table(layout, report.cones, report.tolerance)
    for page in range(layout.pageCollection().pageCount()):
        text = f"{page + 1} / {layout.pageCollection().pageCount()}"
        label = add_text(layout, text, (MARGIN, 285, TEXT_WIDTH, 6), 8, page=page)
        label.setHAlign(Qt.AlignmentFlag.AlignRight)
    return layout


def _told(report: Report) -> str:
    figures = report.figures
    robots = sorted({cone.robot for cone in report.cones if cone.robot})
    times = [cone.at for cone in report.cones if cone.at is not None]
    share = 100.0 * figures.within / figures.count
    lines = [
        tr(
            "{within} of {count} cones ({share:.0f} %) stand within {tolerance:g} cm of their plan.",
            within=figures.within,
            count=figures.count,
            share=share,
            tolerance=report.tolerance * 100,
        ),
        tr(
            "Mean {mean}, RMS {rms}, 95 % within {p95}, largest {most}.",
            mean=_cm(figures.mean),
            rms=_cm(figures.rms),
            p95=_cm(figures.p95),
            most=_cm(figures.most),
        ),
    ]
    facts = []
    if robots:
        names = ", ".join(robots[:8]) + (" …" if len(robots) > 8 else "")
        facts.append(tr("robots: {names}", names=names))
    if times:
        first, last = time_in_words(min(times)), time_in_words(max(times))
        facts.append(tr("{first} to {last} UTC", first=first, last=last))
    lines.append("; ".join([*facts, report.crs.authid() or report.crs.description()]))
    return "\n".join(lines)


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
    bar.attemptMove(corner(MARGIN + 2, 259))
    layout.addLayoutItem(bar)
    words = tr(
        "× planned   ● placed (red: beyond the tolerance)   orange: deviation, {factor} times as long",
        factor=factor,
    )
    add_text(layout, words, (MARGIN, 275.5, TEXT_WIDTH, 6), 8)


def _cm(metres: float) -> str:
    return f"{metres * 100:.1f} cm"
