"""The map tool that sets a cone target."""

from __future__ import annotations

from .draft_tool import DraftTool
from .drafts import CONE, Draft, Point


class ConeTool(DraftTool):
    """A click puts the cone for the selected robot, another click moves it."""

    kind = CONE

    def clicked(self, point: Point) -> None:
        other = self.desk.drafts.draft
        if other is not None and other.kind != CONE:
            self.desk.complained.emit(
                f"{other.in_words()} is still on the map. Send it (Enter) or cancel it (Esc) first."
            )
            return
        robot = self.desk.selected or other.robot
        draft = Draft(robot, CONE, (point,), self.desk.checked((point,)))
        self.desk.drafts.put(draft)
        for text in draft.findings.refused:
            self.desk.complained.emit(text)
