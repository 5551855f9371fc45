"""Asks how the ways are to be that *Route on roads* leads."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QCheckBox, QDoubleSpinBox, QLineEdit, QWidget

from ..language import tr
from .question_dialog import QuestionDialog
from .way_wishes import WayWishes, surfaces_of

WAYS = ((tr("the shortest"), False), (tr("the fastest"), True))
WIDEST = 50.0


class WayWishesDialog(QuestionDialog):
    """Begins with the ``wishes`` that hold; ``confirmed`` carries those that are to hold from now on."""

    confirmed = pyqtSignal(object)

    def __init__(self, wishes: WayWishes, parent: QWidget):
        super().__init__(
            "fleet_way_wishes_dialog",
            tr("Ways on roads"),
            ("fleet_way_wishes_confirm", tr("Lead ways so")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(tr("This holds for every leg that is led from now on, until QGIS is closed."))
        self._way = self.add_choice(tr("Way"), WAYS, "fleet_way_wishes_way")
        self._way.setCurrentIndex(self._way.findData(wishes.fastest))
        self._surfaces = QLineEdit(", ".join(wishes.surfaces))
        self._surfaces.setPlaceholderText(tr("all, or such as: asphalt, concrete"))
        self.add_field(tr("Surfaces"), self._surfaces, "fleet_way_wishes_surfaces")
        self._width = _metres(wishes.least_width)
        self.add_field(tr("Width"), self._width, "fleet_way_wishes_width")
        self._avoid = QCheckBox(tr("Keep off roads on which other robots are sent"))
        self._avoid.setChecked(wishes.avoid_reserved)
        self.add_field("", self._avoid, "fleet_way_wishes_avoid")
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(self.wishes()))

    def wishes(self) -> WayWishes:
        """Return what stands in the fields."""
        return WayWishes(
            fastest=self._way.currentData(),
            surfaces=surfaces_of(self._surfaces.text()),
            least_width=self._width.value(),
            avoid_reserved=self._avoid.isChecked(),
        )


def _metres(value: float) -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setRange(0.0, WIDEST)
    field.setSingleStep(0.5)
    field.setDecimals(1)
    field.setSuffix(" m")
    field.setSpecialValueText(tr("as wide as the robots are"))
    field.setValue(value)
    return field
