"""Roads for commands: closures and conflicts as reported, and the preferences of routes."""

from __future__ import annotations

import uuid
from dataclasses import dataclass

from qgis.PyQt.QtCore import QObject, pyqtSignal
from qgis.PyQt.QtWidgets import QCheckBox, QDoubleSpinBox, QLineEdit, QWidget

from ...robot_bridge.core.messages.json_values import to_json
from ...robot_bridge.core.messages.roads import CloseRoad, ClosureReport, OpenRoad, ResolveConflict
from ..gateway_client.fleet_state import FleetState, OperatorRequest
from ..ui.dialogs import QuestionDialog
from ..ui.language import tr
from .pending_command import Point
from .request_tracker import RequestTracker


class RoadStatus(QObject):
    """What the gateway reports of roads, and what the operator asks about them."""

    def __init__(self, state: FleetState, requests: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._state, self._requests = state, requests
        self.closures_changed = state.closures_changed

    @property
    def closures(self) -> tuple[ClosureReport, ...]:
        """The roads that are closed."""
        return self._state.closures

    def close(self, place: Point, reach: float, reason: str, seconds: float | None) -> str:
        """Ask for the road at ``place`` to be closed and return the closure's id.

        :raises NotSentError: when that cannot be sent.
        """
        closure = str(uuid.uuid4())
        request = CloseRoad(closure, *place, reason or None, seconds, reach)
        self._requests.submit(
            self._order(closure, request),
            tr(
                "Closing the road at {x:.1f}, {y:.1f} m",
                x=place[0],
                y=place[1],
            ),
        )
        return closure

    def open(self, closure: str) -> None:
        """Ask for a closed road to be opened; raises NotSentError when that cannot be sent."""
        self._requests.submit(self._order(str(uuid.uuid4()), OpenRoad(closure)), tr("Opening the road"))

    def resolve(self, robot: str, other: str) -> None:
        """Ask for ``robot`` to give way to ``other``; raises NotSentError when that cannot be sent."""
        request = ResolveConflict(robot, other)
        self._requests.submit(
            self._order(str(uuid.uuid4()), request),
            tr(
                "{robot} gives way to {other}",
                robot=robot,
                other=other,
            ),
        )

    def _order(self, key: str, request: CloseRoad | OpenRoad | ResolveConflict) -> OperatorRequest:
        return OperatorRequest(key, request.method, to_json(request), self._state.clock.steady())


ROUTE_CRITERIA = ((tr("the shortest"), False), (tr("the fastest"), True))
WIDEST_ROAD = 50.0


@dataclass(frozen=True)
class RoutePreferences:
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


SHORTEST = RoutePreferences()


def surfaces_of(text: str) -> tuple[str, ...]:
    """Return the names of surfaces in ``text``, which has commas between them, each once."""
    return tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


class RoutePreferencesDialog(QuestionDialog):
    """Begins with the ``wishes`` that hold; ``confirmed`` carries those that are to hold from now on."""

    confirmed = pyqtSignal(object)

    def __init__(self, wishes: RoutePreferences, parent: QWidget):
        super().__init__(
            "fleet_way_wishes_dialog",
            tr("Ways on roads"),
            ("fleet_way_wishes_confirm", tr("Lead ways so")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(tr("This holds for every leg that is led from now on, until QGIS is closed."))
        self._way = self.add_choice(tr("Way"), ROUTE_CRITERIA, "fleet_way_wishes_way")
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

    def wishes(self) -> RoutePreferences:
        """Return what stands in the fields."""
        return RoutePreferences(
            fastest=self._way.currentData(),
            surfaces=surfaces_of(self._surfaces.text()),
            least_width=self._width.value(),
            avoid_reserved=self._avoid.isChecked(),
        )


def _metres(value: float) -> QDoubleSpinBox:
    field = QDoubleSpinBox()
    field.setRange(0.0, WIDEST_ROAD)
    field.setSingleStep(0.5)
    field.setDecimals(1)
    field.setSuffix(" m")
    field.setSpecialValueText(tr("as wide as the robots are"))
    field.setValue(value)
    return field
