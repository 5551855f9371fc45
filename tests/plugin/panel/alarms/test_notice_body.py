"""A notice with buttons in QGIS's message bar, in a window whose panels leave it more room or less."""

import pytest
from fleet_supervisor.plugin.control.messages import MessageBar, MessageLabel, NoticeBody
from qgis.core import Qgis
from qgis.gui import QgsMessageBar, QgsMessageBarItem
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QDockWidget, QMainWindow, QSizePolicy, QToolButton, QVBoxLayout, QWidget

WIDTH = 1280
NARROW = 430
"""Pixels between the panels: too few for the text and its buttons side by side."""
LONG = (
    "3 alarms: excavator-north is 0.4 m from excavator-south at 48.0, 84.0 m; r7 is off the road; and 1 more"
)


def button(text: str) -> QToolButton:
    made = QToolButton()
    made.setText(text)
    return made


class Hung:
    """A notice that hangs over the map of a window, with a panel on either side."""

    def __init__(self):
        self.window, middle = QMainWindow(), QWidget()
        rows = QVBoxLayout(middle)
        rows.setContentsMargins(0, 0, 0, 0)
        self.bar = bar = QgsMessageBar()
        # As QGIS lays out its own.
        bar.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Fixed)
        rows.addWidget(bar)
        rows.addWidget(QWidget(), 1)
        self.window.setCentralWidget(middle)
        self._panels = [self._panel(side) for side in ("Left", "Right")]
        self.text = MessageLabel(LONG, bar)
        self.buttons = (button("Anzeigen"), button("Alle quittieren"))
        self.body = NoticeBody(self.text, self.buttons, bar)
        self.window.resize(WIDTH, 400)
        self.window.show()
        bar.pushItem(QgsMessageBarItem(self.body, Qgis.MessageLevel.Warning, 0))

    def _panel(self, side: str) -> QWidget:
        dock, content = QDockWidget(side, self.window), QWidget()
        dock.setWidget(content)
        self.window.addDockWidget(getattr(Qt.DockWidgetArea, f"{side}DockWidgetArea"), dock)
        return content

    def leave(self, pixels: int) -> None:
        """Widen the panels until only so many pixels are left between them."""
        for panel in self._panels:
            panel.setFixedWidth((WIDTH - pixels) // 2)

    def is_beside(self) -> bool:
        """Tell whether the buttons are at the right of the text, not beneath it."""
        text, first = (
            widget.mapTo(self.body, widget.rect().center()) for widget in (self.text, self.buttons[0])
        )
        return (
            first.x() > text.x() + self.text.width() // 2 and abs(first.y() - text.y()) < self.text.height()
        )

    def is_whole(self) -> bool:
        """Tell whether the text and every button are as large as their words need."""
        return self.text.height() >= self.text.heightForWidth(self.text.width()) and all(
            one.width() >= one.sizeHint().width() and self.body.rect().contains(_within(one, self.body))
            for one in self.buttons
        )


def _within(widget: QWidget, body: QWidget):
    return widget.rect().translated(widget.mapTo(body, widget.rect().topLeft()))


@pytest.fixture
def hung(qgis_app):
    made = Hung()
    yield made
    made.window.close()
    made.window.deleteLater()


def test_with_room_the_buttons_are_beside_the_text(hung, wait):
    hung.leave(1000)
    wait(lambda: hung.body.width() < 1000, what="the panels")
    wait(hung.is_beside, what="the buttons beside the text")
    assert hung.is_whole()


def test_between_broad_panels_the_buttons_are_beneath_and_the_window_stays(hung, wait):
    hung.leave(NARROW)
    wait(lambda: not hung.is_beside(), what="the buttons beneath the text")
    wait(hung.is_whole, what="the text and its buttons being whole")
    assert hung.window.width() == WIDTH


def test_a_text_without_buttons_leaves_the_window_as_it_is_too(hung, wait):
    MessageBar(hung.bar, hung.window).error(LONG * 3)
    hung.leave(NARROW)
    text = hung.bar.currentItem().findChild(MessageLabel)
    assert text is not hung.text
    wait(lambda: 0 < text.width() < NARROW, what="the text between the panels")
    assert text.height() >= text.heightForWidth(text.width())
    assert hung.window.width() == WIDTH


def test_a_text_is_lower_again_once_it_has_more_room(hung, wait):
    hung.leave(1000)
    wait(hung.is_beside, what="the buttons beside the text")
    hung.text.show_text("shorter")
    single = hung.text.height()
    hung.text.show_text(LONG * 3)
    assert hung.text.height() > single
    hung.text.show_text("shorter still")
    assert hung.text.height() == single
