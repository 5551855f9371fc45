"""The map tool that leads a route along the roads."""

from __future__ import annotations

from qgis.gui import QgsMapMouseEvent

from ...robot_bridge.messages import RouteReport
from ..errors import NotSentError
from ..language import tr
from .desk import Desk
from .drafts import ROUTE, Draft, Point
from .route_preview import Question, in_words
from .route_tool import RouteTool
from .way_to_mouse import WayToMouse
from .way_wishes import SHORTEST, WayWishes


class RoadRouteTool(RouteTool):
    """The way along the roads follows the mouse; a click takes it, and the next leg goes on from there.

    The first leg begins where the robot is. Legs of this tool and of the one that draws can be mixed. Who
    clicks faster than the gateway answers gets the legs one after the other.
    """

    def __init__(self, desk: Desk):
        super().__init__(desk)
        self._way = WayToMouse(desk)
        self.wishes = SHORTEST
        """What is wanted of the legs that are led from now on."""
        self._clicks: list[Point] = []
        """Where ways are still to lead; the first of them is asked for."""
        desk.preview.answered.connect(self._take)
        desk.preview.refused.connect(self._refused)

    def lead_so(self, wishes: WayWishes) -> None:
        """Lead legs by ``wishes`` from now on; what is shown to the mouse is asked for anew."""
        self.wishes = wishes
        self._way.clear()

    def deactivate(self) -> None:
        self._clicks.clear()
        self._way.clear()
        super().deactivate()

    def hovered(self, event: QgsMapMouseEvent) -> None:
        if self._is_finished:
            return
        robot, start = self._from()
        self._way.lead_to(event, robot, start, self.wishes)

    def finish(self) -> None:
        if self._clicks:
            # The ways to what was clicked are still to come, and belong to the route.
            self._is_finished = True
        else:
            super().finish()
        if self._is_finished:
            self._way.hide()

    def clicked(self, point: Point) -> None:
        self._is_finished = False
        draft = self.draft
        if draft is not None and not self.is_for_selected(draft):
            return
        if not self.desk.preview.awaits_click:
            # What was clicked before was given up, or its answer is lost.
            self._clicks.clear()
        self._clicks.append(point)
        if len(self._clicks) == 1:
            self._lead_on()

    def back(self) -> None:
        if not self._clicks:
            super().back()
            return
        self._clicks.pop()
        if not self._clicks:
            self._way.clear()

    def _changed(self) -> None:
        super()._changed()
        if self._clicks and self.desk.drafts.draft is None:
            self._leave_out()

    def _refused(self) -> None:
        self._clicks.clear()
        if self.draft is None:
            self._is_finished = False

    def _lead_on(self) -> None:
        robot, start = self._from()
        question = Question(robot, start, self._clicks[0], taken=True, wishes=self.wishes)
        try:
            self.desk.preview.want(question)
        except NotSentError:
            self._clicks.clear()
            raise

    def _leave_out(self) -> None:
        """Say that the way to the last click comes too late: the draft was sent, or is another."""
        self._clicks.clear()
        self._way.clear()
        self.desk.complained.emit(
            tr("The way to where you clicked last was not known yet, so it is not in the route.")
        )

    def _from(self) -> tuple[str | None, Point | None]:
        """Return whose the next leg is, and where it begins; None for where the robot is."""
        draft = self.draft
        if draft is None:
            return self.desk.selected, None
        return draft.robot, draft.points[-1]

    def _take(self, question: Question, route: RouteReport) -> None:
        if not self._clicks:
            return
        if (question.robot, question.start) != self._from():
            self._leave_out()
            return
        self._try(lambda: self._add(question, route))

    def _add(self, question: Question, route: RouteReport) -> None:
        following, self._clicks = self._clicks[1:], []
        draft = self.draft or Draft(question.robot, ROUTE, ())
        points = route.points if question.start is None else route.points[1:]
        self.put(draft.with_leg(tuple(points), in_words(route, question.wishes)))
        self._clicks = following
        if following:
            self._lead_on()
        if route.note:
            self.desk.complained.emit(tr("This leg does not follow the roads: {note}", note=route.note))
