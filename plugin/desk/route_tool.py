"""The map tool that draws a route."""

from __future__ import annotations

from dataclasses import replace

from qgis.gui import QgsMapMouseEvent

from ..errors import PlacementError
from .draft_tool import DraftTool
from .drafts import ROUTE, Draft, Point


class RouteTool(DraftTool):
    """Each click adds a point to the route of the robot that was selected at the first click."""

    kind = ROUTE

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        if self.draft is None:
            return
        try:
            self.desk.drafts.point_at(self.desk.placement().to_site(event.mapPoint()))
        except PlacementError:
            # A place the site frame cannot express has no preview; a click there says why.
            self.desk.drafts.point_at(None)

    def clicked(self, point: Point) -> None:
        draft = self.draft
        if draft is None:
            draft = Draft(self.desk.selected, ROUTE, ())
        elif self.desk.selected not in (None, draft.robot):
            self.desk.complained.emit(
                f"The route on the map is for {draft.robot}, but {self.desk.selected} is selected. Send it "
                f"(Enter) or cancel it (Esc) first, or select {draft.robot} again."
            )
            return
        self._put(draft, (*draft.points, point))

    def back(self) -> None:
        if self.draft is not None and len(self.draft.points) > 1:
            self._put(self.draft, self.draft.points[:-1])
        else:
            self.desk.drafts.put(None)

    def _put(self, draft: Draft, points: tuple[Point, ...]) -> None:
        draft = replace(draft, points=points, findings=self.desk.checked(points))
        self.desk.drafts.put(draft)
        for text in draft.findings.refused:
            self.desk.complained.emit(text)
