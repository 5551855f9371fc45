"""Asks for a file in a dialog of Qt's own: no key of QGIS works in one of the operating system's.

The emergency stop is one of those keys. Dialogs that QGIS opens itself may still be the operating system's.
"""

from __future__ import annotations

from qgis.gui import QgsFileWidget
from qgis.PyQt.QtWidgets import QFileDialog, QWidget

OURS = QFileDialog.Option.DontUseNativeDialog


def file_to_write(parent: QWidget, title: str, proposal: str, kinds: str) -> str:
    """Return the path that the operator chose to write, or nothing; asks before an existing file is replaced.

    ``proposal`` is the path to begin with, ``kinds`` a filter of Qt's such as ``CSV (*.csv)``.
    """
    path, _ = QFileDialog.getSaveFileName(parent, title, proposal, kinds, options=OURS)
    return path


def file_to_read(parent: QWidget, title: str, folder: str, kinds: str) -> str:
    """Return the path of the existing file that the operator chose, or nothing; begins in ``folder``."""
    path, _ = QFileDialog.getOpenFileName(parent, title, folder, kinds, options=OURS)
    return path


def file_field() -> QgsFileWidget:
    """Return a field for a path whose button opens such a dialog."""
    field = QgsFileWidget()
    field.setOptions(OURS)
    return field
