"""While the operator chooses a file, the key of the emergency stop stops robots."""

import time

import pytest
from fleet_supervisor.plugin.ui.dialogs import file_field, file_to_read, file_to_write
from qgis.gui import QgsFileWidget
from qgis.PyQt.QtCore import Qt, QTimer
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QFileDialog, QToolButton

from tests.support.patience import BUSY


def press_its_button(window, folder):
    field = file_field()
    field.setParent(window)
    field.setStorageMode(QgsFileWidget.StorageMode.GetDirectory)
    field.setDefaultRoot(folder)
    field.show()
    button = next(one for one in field.findChildren(QToolButton) if one.text() == "…")
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    return field.filePath()


class Chooser:
    """What happens while a dialog waits for the operator, which blocks whoever opened it."""

    def __init__(self, gateway):
        self._gateway = gateway
        self._pressed = False
        self._patience_ends = time.monotonic() + 10 * BUSY
        self.was_native = None
        self.stops = 0
        self._timer = QTimer()
        self._timer.timeout.connect(self._look)
        self._timer.start(20)

    def _look(self):
        dialog = QApplication.activeModalWidget()
        if not isinstance(dialog, QFileDialog) or QApplication.activeWindow() is not dialog:
            return
        if not self._pressed:
            self._pressed = True
            self.was_native = not dialog.testOption(QFileDialog.Option.DontUseNativeDialog)
            QTest.keyClick(dialog.focusWidget(), Qt.Key.Key_F10)
        self.stops = len(self._gateway.requests_of("emergency_stop"))
        if self.stops or time.monotonic() > self._patience_ends:
            self._timer.stop()
            dialog.reject()


@pytest.mark.parametrize(
    "choose",
    [
        lambda window, folder: file_to_write(window, "Export", f"{folder}/log.csv", "CSV (*.csv)"),
        lambda window, folder: file_to_read(window, "Import", folder, "JSON (*.json)"),
        press_its_button,
    ],
    ids=["write", "read", "field"],
)
def test_the_key_works_over_a_dialog_for_files(at_desk, gateway, iface, tmp_path, choose):
    chooser = Chooser(gateway)
    assert choose(iface, str(tmp_path)) == ""
    assert chooser.stops == 1
    assert chooser.was_native is False
