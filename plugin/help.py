"""The guides in a window, their topics, F1, and the menu entry Help."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QEvent, QObject, Qt, QUrl
from qgis.PyQt.QtGui import QDesktopServices, QIcon, QTextBlock
from qgis.PyQt.QtWidgets import QAction, QApplication, QDialog, QTextBrowser, QVBoxLayout, QWidget

from .ui.language import tr


@dataclass(frozen=True)
class HelpTopic:
    """A page of docs/ without its suffix, and a heading in it in link form; empty for the page's top."""

    page: str
    heading: str = ""


START = HelpTopic("operator")
CONNECTIONS = HelpTopic("operator", "connections")
OPTIONS = HelpTopic("operator", "options")
ACCOUNTS = HelpTopic("operator", "accounts")
SITES = HelpTopic("operator", "which-site-is-served")
RECORDINGS = HelpTopic("operator", "recordings-on-the-map")

TOPICS = {
    "fleet_url": HelpTopic("operator", "connect"),
    "fleet_operator": HelpTopic("operator", "connect"),
    "fleet_connect_button": HelpTopic("operator", "connect"),
    "fleet_access_button": HelpTopic("operator", "connect"),
    "fleet_token": HelpTopic("operator", "connect"),
    "fleet_ca_file": HelpTopic("operator", "connect"),
    "fleet_connections_button": CONNECTIONS,
    "fleet_robot_table": HelpTopic("operator", "see-the-robots"),
    "fleet_cone_target_button": HelpTopic("operator", "send-a-cone-target"),
    "fleet_road_route_button": HelpTopic("operator", "send-along-the-roads"),
    "fleet_draw_route_button": HelpTopic("operator", "draw-a-route"),
    "fleet_command_log": HelpTopic("operator", "watch-it-being-done"),
    "fleet_queue": HelpTopic("operator", "queues"),
    "fleet_abort_button": HelpTopic("operator", "stop-robots"),
    "fleet_abort_all_button": HelpTopic("operator", "stop-robots"),
    "fleet_emergency_stop_button": HelpTopic("operator", "emergency-stop"),
}
"""By the object name of a widget; applies to all widgets inside it."""


def topic_of(widget: QWidget | None) -> HelpTopic:
    """Return the topic of ``widget`` or the nearest parent that has one."""
    while widget is not None:
        if widget.objectName() in TOPICS:
            return TOPICS[widget.objectName()]
        widget = widget.parentWidget()
    return START


DOCS = Path(__file__).parents[1] / "docs"
WIDTH, HEIGHT = 760, 640


class HelpWindow(QDialog):
    """One page at a time, at the requested heading; links lead on."""

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

    def show_topic(self, topic: HelpTopic) -> None:
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
            self.show_topic(HelpTopic(path.stem, url.fragment()))


def heading_link(heading: str) -> str:
    """Return the link form of ``heading``."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def show_help(topic: HelpTopic, parent: QWidget) -> HelpWindow:
    """Show ``topic`` in a window that belongs to ``parent``'s, which may be a dialog that blocks others."""
    owner = parent.window()
    window = owner.findChild(HelpWindow, options=Qt.FindChildOption.FindDirectChildrenOnly)
    window = window or HelpWindow(owner)
    window.show_topic(topic)
    return window


ICON = Path(__file__).parents[1] / "resources" / "icons" / "fleet.svg"


class HelpActions(QObject):
    """Handles F1 within ``panel`` by the widget with the focus. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, panel: QWidget):
        super().__init__(iface.mainWindow())
        self._iface, self._menu, self._panel = iface, menu, panel
        self.action = QAction(QIcon(str(ICON)), tr("Fleet Supervisor help"), self)
        self.action.setObjectName("fleet_help_action")
        self.action.triggered.connect(lambda: show_help(START, iface.mainWindow()))
        iface.addPluginToMenu(menu, self.action)
        iface.pluginHelpMenu().addAction(self.action)
        panel.installEventFilter(self)

    def remove(self) -> None:
        """Close open windows and remove the entries from the menus."""
        # Not among all children of the main window, for each of which PyQt makes an object.
        for window in QApplication.topLevelWidgets():
            if isinstance(window, HelpWindow):
                window.close()
        self._panel.removeEventFilter(self)
        self._iface.pluginHelpMenu().removeAction(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.deleteLater()

    def eventFilter(self, panel: QObject, event: QEvent) -> bool:
        kinds = (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress)
        if event.type() not in kinds or event.key() != Qt.Key.Key_F1:
            return False
        # QGIS uses F1 for its own help: with the shortcut overridden, it is delivered as a key.
        event.accept()
        if event.type() == QEvent.Type.KeyPress:
            show_help(topic_of(QApplication.focusWidget()), self._panel)
        return True
