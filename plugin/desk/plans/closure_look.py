"""Looks which ways of plans lead along closed roads, without holding the window up."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from qgis.PyQt.QtCore import QObject

from ....robot_bridge.messages import ClosureReport
from ..time_slices import Steps, TimeSlices
from .draft import Draft


class ClosureLook(QObject):
    """One look at a time: ten roads and four hundred ways take a tenth of a second, in slices."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._slices = TimeSlices(self)

    def begin(
        self,
        drafts: Sequence[Draft],
        closures: Sequence[ClosureReport],
        done: Callable[[list[Draft]], None],
    ) -> None:
        """Call ``done`` with ``drafts`` as these roads leave them, at once where that is soon found.

        A look that is under way is given up.
        """
        found = self._slices.begin(_looked_at(drafts, closures), done=done)
        if found is not None:
            done(found)

    def stop(self) -> None:
        """Look no more; what was asked for is not told."""
        self._slices.stop()


def _looked_at(drafts: Sequence[Draft], closures: Sequence[ClosureReport]) -> Steps[list[Draft]]:
    found = []
    for draft in drafts:
        found.append((yield from draft.with_closures(closures)))
    return found
