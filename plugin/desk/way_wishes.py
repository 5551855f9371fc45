"""What an operator wants of the ways that *Route on roads* leads, and how that is asked."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QCheckBox, QDoubleSpinBox, QLineEdit, QWidget

from ..language import tr
from .question_dialog import QuestionDialog

WAYS = ((tr("the shortest"), False), (tr("the fastest"), True))
WIDEST = 50.0


@dataclass(frozen=True)
class WayWishes:
    """The shortest way along all roads, unless something else is wanted.

    ``surfaces`` names those that may be used, none of them: all. ``least_width`` is what a road must have,
    in metres, beside the width of the site's robots. ``avoid_reserved`` leaves out the roads on which other
    robots' tasks lead.
    """

    fastest: bool = False
    surfaces: tuple[str, ...] = ()
    least_width: float = 0.0
    avoid_reserved: bool = False

    def in_words(self) -> list[str]:
        """Return what is wanted beyond the shortest way, a text for each."""
        words = []
        if self.fastest:
            words.append(tr("the fastest way"))
        if self.avoid_reserved:
            words.append(tr("off the roads of other robots"))
        if self.surfaces:
            words.append(tr("only on {surfaces}", surfaces=", ".join(self.surfaces)))
        if self.least_width:
            words.append(tr("roads at least {metres:g} m wide", metres=self.least_width))
        return words


SHORTEST = WayWishes()


def surfaces_of(text: str) -> tuple[str, ...]:
    """Return the names of surfaces in ``text``, which has commas between them, each once."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


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
