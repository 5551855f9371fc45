"""Coordinates typed in, in any CRS, with where they come to on the site and by which way."""

from __future__ import annotations

from qgis.core import QgsCoordinateReferenceSystem
from qgis.gui import QgsProjectionSelectionWidget
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from ...errors import FleetError
from ...language import tr
from ..colours import WRONG_STYLE
from ..desk import Desk
from ..drafting.datum_path import datum_path
from ..drafting.typed_place import read_site_place
from ..drafts import Point

WGS84 = "EPSG:4326"


class CoordinatesDialog(QDialog):
    """Stays open: each press of the button, or Enter, sets the place; nothing here sends anything."""

    chosen = pyqtSignal(float, float)
    """A place in the site frame."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_coordinates_dialog")
        self.setWindowTitle(tr("Coordinates"))
        self.setMinimumWidth(460)
        self._desk = desk
        self._place: Point | None = None
        self._text = QLineEdit()
        self._text.setObjectName("fleet_coordinates_text")
        self._text.setPlaceholderText("48.2083, 16.3725")
        self._crs = QgsProjectionSelectionWidget()
        self._crs.setObjectName("fleet_coordinates_crs")
        self._crs.setCrs(QgsCoordinateReferenceSystem(WGS84))
        self._told = QLabel()
        self._told.setObjectName("fleet_coordinates_told")
        self._told.setWordWrap(True)
        self._told.setTextFormat(Qt.TextFormat.PlainText)
        self._told.setMinimumHeight(4 * self._told.fontMetrics().lineSpacing())
        self._told.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        self._set = QPushButton(tr("Set on the map"))
        self._set.setObjectName("fleet_coordinates_set")
        self._lay_out()
        # Only within the dialog: Enter would be another button's once that had the keyboard.
        self._set.setDefault(True)
        self._text.textChanged.connect(self._read)
        self._crs.crsChanged.connect(self._read)
        self._set.clicked.connect(self._choose)
        desk.site_changed.connect(self._read)
        self._read()

    def ask(self) -> None:
        """Come to the front, with what was written last in hand: what is typed takes its place."""
        self.show()
        self.raise_()
        self.activateWindow()
        self._text.setFocus()
        self._text.selectAll()

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.addRow(tr("&Coordinates"), self._text)
        form.addRow(tr("C&RS"), self._crs)
        buttons = QDialogButtonBox()
        buttons.addButton(self._set, QDialogButtonBox.ButtonRole.ApplyRole)
        buttons.addButton(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        rows = QVBoxLayout(self)
        rows.addLayout(form)
        rows.addWidget(self._told)
        rows.addWidget(buttons)

    def _read(self, *_: object) -> None:
        self._place = None
        self._told.setStyleSheet("")
        try:
            self._told.setText(self._in_words())
        except FleetError as error:
            self._told.setText(str(error))
            if self._text.text().strip():
                self._told.setStyleSheet(WRONG_STYLE)
        self._set.setEnabled(self._place is not None)

    def _in_words(self) -> str:
        """Read what is entered and return where that is.

        :raises FleetError: when it is no place, or there is no site yet.
        """
        crs = self._crs.crs()
        site_crs = self._desk.placement().site_crs
        context = self._desk.project.transformContext()
        path = datum_path(crs, site_crs, context).in_words()
        if not self._text.text().strip():
            order = tr("latitude, longitude") if crs.isGeographic() else tr("x, y")
            return tr("Write {order} in {crs}.\n{path}", order=order, crs=crs.authid(), path=path)
        self._place = read_site_place(self._text.text(), crs, self._desk.site, context)
        site = tr("{x:.2f}, {y:.2f} m on the site", x=self._place[0], y=self._place[1])
        ((east, north),) = self._desk.placement().frame.to_crs([self._place])
        return tr(
            "{site}; {east:.2f}, {north:.2f} in {crs}.\n{path}",
            site=site,
            east=east,
            north=north,
            crs=site_crs.authid(),
            path=path,
        )

    def _choose(self) -> None:
        if self._place is not None:
            self.chosen.emit(*self._place)
