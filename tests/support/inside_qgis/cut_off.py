"""Finds what a window shows only in part: words that do not fit on what bears them."""

from __future__ import annotations

from collections.abc import Iterator

from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QGroupBox,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QStyle,
    QStyleOptionComboBox,
    QTabBar,
    QToolBar,
    QToolButton,
    QWidget,
)

ROUNDING = 2
"""Pixels that styles differ by in what they ask for and what they need."""
HEADER_EDGE = 4
"""Pixels beside the words of a column's head."""


def too_large(window: QWidget, room: QSize) -> list[str]:
    """Return what of a window needs more than ``room``."""
    needs = window.minimumSizeHint().expandedTo(window.size())
    if needs.width() <= room.width() and needs.height() <= room.height():
        return []
    return [f"{_named(window)} needs {needs.width()} × {needs.height()} pixels"]


def cut_off(window: QWidget) -> list[str]:
    """Return, in words, each visible part of ``window`` that is too small for what it says."""
    found = []
    for part in [window, *window.findChildren(QWidget)]:
        if part.isVisible() and part.window() is window.window():
            found += [f"{_named(part)}: {why}" for why in (*_faults(part), *_beyond_its_view(part))]
    return found


def _faults(part: QWidget) -> Iterator[str]:
    if isinstance(part, QTabBar):
        yield from _of_tabs(part)
    elif isinstance(part, QHeaderView):
        yield from _of_heads(part)
    elif isinstance(part, QComboBox):
        yield from _of_choices(part)
    elif isinstance(part, QLabel):
        yield from _of_label(part)
    elif isinstance(part, QGroupBox):
        yield from _if_narrow(part.title(), part.width(), part.minimumSizeHint().width())
    elif isinstance(part, QLineEdit):
        yield from _of_line(part)
    elif isinstance(part, QAbstractButton) and not _may_shrink(part):
        yield from _if_narrow(part.text(), part.width(), _needed(part))


def _beyond_its_view(part: QWidget) -> Iterator[str]:
    """Tell of a part that ends beyond what it is scrolled in, where that is not scrolled sideways."""
    view = part.parentWidget()
    while view is not None and not isinstance(view.parentWidget(), QScrollArea):
        view = view.parentWidget()
    if view is not None and view.parentWidget().viewport() is view and not _is_scrolled(view.parentWidget()):
        right = part.mapTo(view, part.rect().topRight()).x()
        if right > view.width():
            yield f"it ends {right - view.width()} pixels beyond what shows it"


def _is_scrolled(area: QScrollArea) -> bool:
    return area.horizontalScrollBarPolicy() != Qt.ScrollBarPolicy.ScrollBarAlwaysOff


def _needed(button: QAbstractButton) -> int:
    """Return the width for a button's icon and words, without what only looks roomy."""
    hint = button.sizeHint().width()
    if isinstance(button, QPushButton):
        words = button.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, button.text()).width()
        icon = 0 if button.icon().isNull() else button.iconSize().width() + 4
        return min(hint, words + icon + 8)
    return hint


def _may_shrink(button: QAbstractButton) -> bool:
    """Tell whether it is one of a toolbar, which has a menu for what does not fit, or has no words."""
    return isinstance(button.parentWidget(), (QToolBar, QHeaderView)) or (
        isinstance(button, QToolButton)
        and button.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly
        and not button.icon().isNull()
    )


def _if_narrow(text: str, has: int, needs: int) -> Iterator[str]:
    if text and has + ROUNDING < needs:
        yield f"{text!r} needs {needs} pixels and has {has}"


def _of_label(label: QLabel) -> Iterator[str]:
    text = label.text()
    if not text or (label.pixmap() is not None and not label.pixmap().isNull()):
        return
    if label.wordWrap():
        needs = label.heightForWidth(label.width())
        if label.height() + ROUNDING < needs:
            yield f"{text!r} needs a height of {needs} pixels and has {label.height()}"
    elif label.sizePolicy().horizontalPolicy() != label.sizePolicy().Policy.Ignored or not label.toolTip():
        # What gives way on purpose says all of it in its tool tip.
        yield from _if_narrow(text, label.width(), label.sizeHint().width())


def _of_line(line: QLineEdit) -> Iterator[str]:
    hint = line.placeholderText()
    if hint and not line.text() and not line.toolTip():
        margins = line.textMargins()
        frame = 2 * line.style().pixelMetric(QStyle.PixelMetric.PM_DefaultFrameWidth, None, line) + 4
        yield from _if_narrow(
            hint,
            line.width() - frame - margins.left() - margins.right(),
            line.fontMetrics().horizontalAdvance(hint),
        )


def _of_choices(box: QComboBox) -> Iterator[str]:
    option = QStyleOptionComboBox()
    option.initFrom(box)
    option.editable, option.frame = box.isEditable(), box.hasFrame()
    field = box.style().subControlRect(
        QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, box
    )
    words = box.fontMetrics().horizontalAdvance(box.currentText())
    icon = 0 if box.itemIcon(box.currentIndex()).isNull() else box.iconSize().width() + 4
    if box.toolTip() != box.currentText():
        yield from _if_narrow(box.currentText(), field.width(), words + icon)


def _of_tabs(bar: QTabBar) -> Iterator[str]:
    last = bar.tabRect(bar.count() - 1).right() if bar.count() else 0
    if last > bar.width():
        yield f"its tabs need {last} pixels and have {bar.width()}"
    for tab in range(bar.count()):
        words = bar.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, bar.tabText(tab)).width()
        yield from _if_narrow(bar.tabText(tab), bar.tabRect(tab).width(), words)


def _of_heads(heads: QHeaderView) -> Iterator[str]:
    model = heads.model()
    if model is None or heads.orientation() != Qt.Orientation.Horizontal:
        return
    for section in range(heads.count()):
        text = str(model.headerData(section, heads.orientation(), Qt.ItemDataRole.DisplayRole) or "")
        if not heads.isSectionHidden(section):
            words = heads.fontMetrics().horizontalAdvance(text) + HEADER_EDGE
            yield from _if_narrow(text, heads.sectionSize(section), words)


def _named(part: QWidget) -> str:
    """Return a widget's object name, or that of what it lies in."""
    name = part.objectName()
    above = part.parentWidget()
    while not name.startswith("fleet") and above is not None:
        name, above = above.objectName(), above.parentWidget()
    return f"{type(part).__name__} in {name}" if name != part.objectName() else name
