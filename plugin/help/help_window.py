"""Shows the guides that come with the plugin; it needs no network."""

from __future__ import annotations

import re
from pathlib import Path

from qgis.PyQt.QtCore import Qt, QUrl
from qgis.PyQt.QtGui import QDesktopServices, QTextBlock
from qgis.PyQt.QtWidgets import QDialog, QTextBrowser, QVBoxLayout, QWidget

from ..language import tr
from .topics import START, Topic

DOCS = Path(__file__).parents[2] / "docs"
WIDTH, HEIGHT = 760, 640


class HelpWindow(QDialog):
    """One page at a time, at the heading that was asked for; links lead on."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_help")
        self.setWindowTitle(tr("Fleet Supervisor: help"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.topic = START
        self.browser = QTextBrowser()
        self.browser.setObjectName("fleet_help_text")
        # Links are followed here: a page of Markdown is not what the browser would open.
        self.browser.setOpenLinks(False)
        self.browser.anchorClicked.connect(self._follow)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.addWidget(self.browser)
        self.resize(WIDTH, HEIGHT)

    def show_topic(self, topic: Topic) -> None:
        """Show a page, from its heading on."""
        if topic.page != self.topic.page or self.browser.document().isEmpty():
            self._read(topic.page)
        self.topic = topic
        self.show()
        self.raise_()
        self._scroll_to(topic.heading)

    def _read(self, page: str) -> None:
        file = DOCS / f"{page}.md"
        document = self.browser.document()
        document.setBaseUrl(QUrl.fromLocalFile(f"{DOCS}/"))
        try:
            text = file.read_text(encoding="utf-8")
        except OSError as error:
            text = tr(
                "# Help\n\n{file} cannot be read: {strerror}. Install the plugin again.",
                file=file,
                strerror=error.strerror,
            )
        # Pictures are as wide as screens; a page is not.
        document.setMarkdown(re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text))

    def _scroll_to(self, heading: str) -> None:
        block = self._block(heading)
        top = 0.0
        if block is not None:
            top = self.browser.document().documentLayout().blockBoundingRect(block).top()
        self.browser.verticalScrollBar().setValue(round(top))

    def _block(self, heading: str) -> QTextBlock | None:
        block = self.browser.document().begin()
        while block.isValid():
            if block.blockFormat().headingLevel() and heading_link(block.text()) == heading:
                return block
            block = block.next()
        return None

    def _follow(self, url: QUrl) -> None:
        if url.scheme() in ("http", "https"):
            QDesktopServices.openUrl(url)
            return
        path = Path(url.path() or f"{self.topic.page}.md")
        if path.suffix == ".md" and (DOCS / path.name).is_file():
            self.show_topic(Topic(path.stem, url.fragment()))


def heading_link(heading: str) -> str:
    """Return what a link to ``heading`` is written with."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def show_help(topic: Topic, parent: QWidget) -> HelpWindow:
    """Show ``topic`` in a window that belongs to ``parent``'s, which may be a dialog that blocks others."""
    owner = parent.window()
    window = owner.findChild(HelpWindow, options=Qt.FindChildOption.FindDirectChildrenOnly)
    window = window or HelpWindow(owner)
    window.show_topic(topic)
    return window
