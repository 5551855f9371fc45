"""The cones that robots put down, as an ordinary layer: what was reached stays on the map."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from qgis.core import QgsMarkerSymbol, QgsSingleSymbolRenderer, QgsVectorLayer
from qgis.PyQt.QtCore import QObject

from ...robot_bridge.messages import CommandReport, CommandState
from ..language import tr
from .command_book import DRIVES, place_of
from .desk import Desk
from .row_layer import Row, RowLayer
from .wall_clock import date_and_time

FIELDS = "robot:string,label:string,placed_at:string,deviation_m:double"
MOST = 2000
"""Cones that are shown: of more the newest."""


class StandingCones(QObject):
    """A layer of the cones that queues' tasks put down and nobody has collected, and of cone targets that
    were reached, straight or along a path. :meth:`remove` takes it out of the project.
    """

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._reached: dict[str, CommandReport] = {}
        self._layer = RowLayer(
            desk.project, "standing_cones", tr("Cones put down"), "Point", FIELDS, _style_cones
        )
        desk.commands_changed.connect(self._add_reached)
        desk.placements_changed.connect(self._show)
        desk.site_changed.connect(self._site_changed)

    def remove(self) -> None:
        """Take the layer out of the project."""
        self._layer.remove()

    def _add_reached(self, reports: Iterable[CommandReport]) -> None:
        new = {report.command: report for report in reports if _is_cone_put_down(report)}
        if new:
            self._reached.update(new)
            for command in list(self._reached)[:-MOST]:
                del self._reached[command]
            self._show()

    def _site_changed(self) -> None:
        # Another site's commands are out of the book by now.
        self._reached = {command: one for command, one in self._reached.items() if command in self._desk.book}
        self._show()

    def _show(self, *_: object) -> None:
        self._layer.show(list(self._rows())[-MOST:], self._desk.site)

    def _rows(self) -> Iterator[Row]:
        known = set()
        for cone in self._desk.placements:
            known.add(cone.command)
            if cone.collected_at is None:
                values = [cone.robot, cone.label or cone.cone or "", date_and_time(cone.placed_at)]
                yield [(cone.x, cone.y)], [*values, cone.deviation]
        for command, report in self._reached.items():
            place = place_of(report)
            if command not in known and place is not None:
                at = report.steps[-1].at if report.steps else None
                yield [place], [report.robot, "", date_and_time(at), report.deviation]


def _is_cone_put_down(report: CommandReport) -> bool:
    is_cone = report.op in DRIVES and report.params.get("cone") is True
    return is_cone and report.state is CommandState.REACHED


def _style_cones(layer: QgsVectorLayer) -> None:
    mark = {
        "name": "triangle",
        "color": "242,106,27,255",
        "outline_color": "255,255,255,255",
        "outline_width": "0.4",
        "size": "3.6",
    }
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(mark)))
