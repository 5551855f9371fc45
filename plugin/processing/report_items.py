"""Texts, places and pages of a report, in millimetres."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import (
    QgsLayoutItem,
    QgsLayoutItemLabel,
    QgsLayoutItemPage,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLayoutUtils,
    QgsPrintLayout,
    QgsTextFormat,
    QgsTextRenderer,
    QgsUnitTypes,
)

PAGE = (210.0, 297.0)
"""Millimetres, as everything here."""
MARGIN = 15.0
TEXT_WIDTH = PAGE[0] - 2 * MARGIN


def a4_page(layout: QgsPrintLayout) -> QgsLayoutItemPage:
    """Return a page for ``layout``, upright."""
    page = QgsLayoutItemPage(layout)
    page.setPageSize("A4", QgsLayoutItemPage.Orientation.Portrait)
    return page


def add_text(
    layout: QgsPrintLayout,
    text: str,
    area: tuple[float, float, float, float],
    size: float,
    *,
    bold: bool = False,
    page: int = 0,
) -> QgsLayoutItemLabel:
    """Add ``text`` in letters of ``size`` points and return its label; ``area`` is as for :func:`put`."""
    label = QgsLayoutItemLabel(layout)
    label.setText(text)
    letters = text_format(size, bold=bold)
    if hasattr(label, "setTextFormat"):
        label.setTextFormat(letters)
    else:
        # QGIS 3.22.
        label.setFont(letters.toQFont())
    put(label, area, page)
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
    """Return what tells how wide a text is in ``letters``, in millimetres."""
    context = QgsLayoutUtils.createRenderContextForLayout(layout, None)
    millimetre = context.convertToPainterUnits(1.0, QgsUnitTypes.RenderUnit.RenderMillimeters)
    return lambda text: QgsTextRenderer.textWidth(context, letters, [text]) / millimetre


def put(item: QgsLayoutItem, area: tuple[float, float, float, float], page: int = 0) -> None:
    """Put ``item`` into ``area`` of a page: left, top, width, height."""
    left, top, width, height = area
    item.attemptResize(QgsLayoutSize(width, height, QgsUnitTypes.LayoutUnit.LayoutMillimeters))
    item.attemptMove(corner(left, top), page=page)


def corner(left: float, top: float) -> QgsLayoutPoint:
    """Return a place on a page."""
    return QgsLayoutPoint(left, top, QgsUnitTypes.LayoutUnit.LayoutMillimeters)
