"""Widgets whose size does not depend on their text: no text moves the button beside or below it."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import QEvent, QSize, Qt
from qgis.PyQt.QtGui import QColor, QMouseEvent, QPaintEvent, QPalette, QResizeEvent
from qgis.PyQt.QtWidgets import (
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStyle,
    QStyleOptionButton,
    QTabBar,
    QTabWidget,
    QToolButton,
    QWidget,
)

from .glyphs import painting
from .language import plain_tip

NARROWEST = 60
"""Width in pixels that a text requests; it uses what is available."""
AROUND_TEXT = 3
"""Pixels above and below a text."""
AROUND_BUTTON_TEXT = 6
"""Pixels of a button at either side of its text."""
UNDERLINE = 3
"""Pixels of the line beneath a title in a colour."""
MOST_COUNTED = 99
"""The largest number shown on a tab."""


class ScrollingText(QScrollArea):
    """Plain text that wraps, in an area of ``lines`` lines; a longer text scrolls.

    The whole text is its tool tip too, unless another one is set. The label inside has the object name
    ``name``.
    """

    def __init__(self, name: str, lines: int, text: str = "", *, framed: bool = False):
        super().__init__()
        self._lines, self._has_own_tip = lines, False
        self._label = QLabel()
        self._label.setObjectName(name)
        self._label.setWordWrap(True)
        self._label.setTextFormat(Qt.TextFormat.PlainText)
        self._label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._label.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        side = 4 if framed else 0
        self._label.setContentsMargins(side, 1, side, 1)
        self.setFrameShape(QFrame.Shape.StyledPanel if framed else QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setWidgetResizable(True)
        self.setWidget(self._label)
        self.viewport().setAutoFillBackground(False)
        self._label.setAutoFillBackground(False)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setText(text)

    @property
    def label(self) -> QLabel:
        """The label with the text."""
        return self._label

    def text(self) -> str:
        """Return the whole text."""
        return self._label.text()

    def setText(self, text: str) -> None:
        """Show ``text`` from its beginning."""
        if text == self._label.text():
            return
        self._label.setText(text)
        self.verticalScrollBar().setValue(0)
        if not self._has_own_tip:
            self._label.setToolTip(plain_tip(text))

    def setToolTip(self, tip: str) -> None:
        self._has_own_tip = True
        self._label.setToolTip(tip)

    def toolTip(self) -> str:
        return self._label.toolTip()

    def set_text_style(self, style: str) -> None:
        """Show the text in this style sheet."""
        if style != self._label.styleSheet():
            self._label.setStyleSheet(style)

    def sizeHint(self) -> QSize:
        # Before it is shown it would have the font of another style.
        self._label.ensurePolished()
        around = 2 * (self.frameWidth() + AROUND_TEXT)
        return QSize(NARROWEST, self._lines * self._label.fontMetrics().lineSpacing() + around)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self.updateGeometry()


class ElidedText(QLabel):
    """One line of plain text, elided where there is no more room; its tool tip is the whole text."""

    def __init__(self, name: str, text: str = ""):
        super().__init__()
        self.setObjectName(name)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setText(text)

    def setText(self, text: str) -> None:
        super().setText(text)
        self.setToolTip(plain_tip(text))

    def sizeHint(self) -> QSize:
        return QSize(NARROWEST, self.fontMetrics().lineSpacing() + AROUND_TEXT)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def paintEvent(self, event: QPaintEvent) -> None:
        room = self.contentsRect()
        line = " ".join(self.text().splitlines())
        shown = self.fontMetrics().elidedText(line, Qt.TextElideMode.ElideRight, room.width())
        with painting(self) as painter:
            self.style().drawItemText(
                painter,
                room,
                int(self.alignment()),
                self.palette(),
                self.isEnabled(),
                shown,
                self.foregroundRole(),
            )


def _width(widget: QWidget, text: str) -> int:
    """Return the width that Qt measures for ``text``; the drawn width may differ by a pixel."""
    return widget.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, text).width()


class _Steady:
    """Requests room for the longest of the texts that a button may have, whichever it has now."""

    _texts: tuple[str, ...] = ()

    def sizeHint(self) -> QSize:
        more = max(_width(self, text) for text in self._texts) - _width(self, self.text())
        hint = super().sizeHint()
        return QSize(hint.width() + more, hint.height())

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        # The first press has changed the button's meaning: the second one was not meant for that.
        event.accept()


class SteadyButton(_Steady, QToolButton):
    """A tool button that shows one of ``texts`` at a time; a double click is one press."""

    def __init__(self, name: str, texts: Sequence[str]):
        super().__init__()
        self.setObjectName(name)
        self._texts = tuple(texts)


class SteadyPushButton(_Steady, QPushButton):
    """A push button that shows one of ``texts`` at a time, the first one initially."""

    def __init__(self, name: str, texts: Sequence[str]):
        super().__init__(texts[0])
        self.setObjectName(name)
        self._texts = tuple(texts)

    def sizeHint(self) -> QSize:
        # A style gives short texts a minimum width, to which the others must not be added.
        hints = []
        for text in self._texts:
            option = QStyleOptionButton()
            self.initStyleOption(option)
            option.text = text
            contents = self.fontMetrics().size(Qt.TextFlag.TextShowMnemonic, text)
            kind = QStyle.ContentsType.CT_PushButton
            hints.append(self.style().sizeFromContents(kind, option, contents, self))
        return QSize(max(hint.width() for hint in hints), max(hint.height() for hint in hints))


class ElidedButton(QToolButton):
    """Uses the width available; a longer text is elided, and its tool tip begins with the whole text."""

    def __init__(self, name: str):
        super().__init__()
        self.setObjectName(name)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._whole = self._tip = ""

    def set_words(self, text: str, tip: str = "") -> None:
        """Show ``text``; ``tip`` adds details."""
        if (text, tip) != (self._whole, self._tip):
            self._whole, self._tip = text, tip
            self._fit()

    def sizeHint(self) -> QSize:
        return QSize(NARROWEST, super().sizeHint().height())

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        room = max(0, self.width() - 2 * AROUND_BUTTON_TEXT)
        shown = self.fontMetrics().elidedText(self._whole, Qt.TextElideMode.ElideRight, room)
        self.setText(shown)
        is_cut = shown != self._whole
        self.setToolTip(plain_tip("\n".join([self._whole] * is_cut + [self._tip] * bool(self._tip))))


class _SteadyTabBar(QTabBar):
    """Requests room for the longest title of each tab, which is its data, and underlines some in colours."""

    def __init__(self) -> None:
        super().__init__()
        self._lines: dict[int, QColor] = {}

    def underline(self, tab: int, colour: QColor | None) -> None:
        """Draw a line of ``colour`` at the foot of a tab; None for none."""
        if self._lines.get(tab) == colour:
            return
        self._lines.pop(tab, None)
        if colour is not None:
            self._lines[tab] = colour
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        with painting(self) as painter:
            for tab, colour in self._lines.items():
                place = self.tabRect(tab)
                painter.fillRect(place.adjusted(2, place.height() - UNDERLINE, -2, 0), colour)

    def tabSizeHint(self, index: int) -> QSize:
        hint = super().tabSizeHint(index)
        more = max(0, _width(self, self.tabData(index) or "") - _width(self, self.tabText(index)))
        return QSize(hint.width() + more, hint.height())

    def minimumTabSizeHint(self, index: int) -> QSize:
        return self.tabSizeHint(index)


class SteadyTabs(QTabWidget):
    """Tabs that stay in place when a number is shown behind a title."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._bar = _SteadyTabBar()
        self.setTabBar(self._bar)
        self.setDocumentMode(True)
        font = self.tabBar().font()
        font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
        self.tabBar().setFont(font)
        # Scroll arrows would come and go, and move the pages below.
        self.setUsesScrollButtons(False)

    def add_page(self, page: QWidget, title: str, *, counts: bool = False) -> None:
        """Add a page; one that ``counts`` has room for a number behind its title."""
        tab = self.addTab(page, title)
        self.tabBar().setTabData(tab, _counted(title, MOST_COUNTED + 1) if counts else title)

    def show_count(self, page: QWidget, title: str, number: int) -> None:
        """Show ``number`` behind the title of a page; nothing for 0."""
        self.setTabText(self.indexOf(page), _counted(title, number) if number else title)

    def show_colour(self, page: QWidget, colour: QColor | None) -> None:
        """Show the title of a page in ``colour`` and underline it, None for the default.

        QGIS's dark themes set the text colour of every tab.
        """
        plain = self.palette().color(QPalette.ColorRole.WindowText)
        self.tabBar().setTabTextColor(self.indexOf(page), colour or plain)
        self._bar.underline(self.indexOf(page), colour)


def _counted(title: str, number: int) -> str:
    return f"{title} ({number})" if number <= MOST_COUNTED else f"{title} ({MOST_COUNTED}+)"
