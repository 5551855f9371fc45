"""The map tool that leads a route along the roads."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent

from ...robot_bridge.messages import RouteReport
from ..language import tr
from .desk import Desk
from .drafts import ROUTE, Draft, Point
from .route_preview import Question, in_words
from .route_tool import RouteTool
from .way_to_mouse import WayToMouse
from .way_wishes import SHORTEST, WayWishes


class RoadRouteTool(RouteTool):
    """The way along the roads follows the mouse; a click takes it, and the next leg goes on from there.

    The first leg begins where the robot is. Legs of this tool and of the one that draws can be mixed.
    """

    def __init__(self, desk: Desk):
        super().__init__(desk)
        self._way = WayToMouse(desk)
        self.wishes = SHORTEST
        """What is wanted of the legs that are led from now on."""
        desk.preview.answered.connect(self._take)

    def lead_so(self, wishes: WayWishes) -> None:
        """Lead legs by ``wishes`` from now on; what is shown to the mouse is asked for anew."""
        self.wishes = wishes
        self._way.clear()

    def deactivate(self) -> None:
        self._way.clear()
        super().deactivate()

    def hovered(self, event: QgsMapMouseEvent) -> None:
        robot, start = self._from()
        self._way.lead_to(event, robot, start, self.wishes)

    def clicked(self, point: Point) -> None:
        robot, start = self._from()
        draft = self.draft
        if robot is not None and (draft is None or self.is_for_selected(draft)):
            question = Question(robot, start, point, taken=True, wishes=self.wishes)
            self.desk.preview.want(question)

    def _from(self) -> tuple[str | None, Point | None]:
        """Return whose the next leg is, and where it begins; None for where the robot is."""
        draft = self.draft
        if draft is None:
            return self.desk.selected, None
        return draft.robot, draft.points[-1]

    def _take(self, question: Question, route: RouteReport) -> None:
        if (question.robot, question.start) != self._from() or self.canvas().mapTool() is not self:
            # Something else was drawn in the meantime, so that the leg would not fit.
            return
        draft = self.draft or Draft(question.robot, ROUTE, ())
        points = route.points if question.start is None else route.points[1:]
        self.put(draft.with_leg(tuple(points), in_words(route, question.wishes)))
        if route.note:
            self.desk.complained.emit(tr("This leg does not follow the roads: {note}", note=route.note))
