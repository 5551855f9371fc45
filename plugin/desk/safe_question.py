"""A question before something is done that cannot be taken back: Enter and Escape leave all as it is."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QMessageBox, QWidget


def safe_question(
    parent: QWidget, name: str, text: str, yes: tuple[str, str], no: str, then: Callable[[], object]
) -> QMessageBox:
    """Return a question, the object ``name``, that is not open yet; its title is for the caller to set.

    ``yes`` is the name and the text of the button that does ``then()``, ``no`` the text of the one that does
    nothing, which Enter and Escape press.
    """
    box = QMessageBox(QMessageBox.Icon.Question, "", text, parent=parent)
    box.setObjectName(name)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    confirm = box.addButton(yes[1], QMessageBox.ButtonRole.AcceptRole)
    confirm.setObjectName(yes[0])
    keep = box.addButton(no, QMessageBox.ButtonRole.RejectRole)
    box.setDefaultButton(keep)
    box.setEscapeButton(keep)
    confirm.clicked.connect(lambda: then())
    return box
