"""Asks the gateway for observations and their images, and tells it what operators make of them."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import (
    GetImage,
    GetObservations,
    ObservationReport,
    ObservationState,
    ReviewObservation,
)
from ...errors import FleetError
from ...language import tr
from ...wire.outbox import Answer
from ...wire.status import Phase
from ..desk import Desk
from .thumbnails import Thumbnails

PAGE = 500
REVIEWED = 200
"""Reviewed ones that are asked for when a link begins."""


class ObservationFeed(QObject):
    """Fetches all that wait for review, page by page, and one image after the other.

    ``reviewed`` has the number of an observation whose review the gateway took in, ``refused`` that and why
    it did not.
    """

    reviewed = pyqtSignal(int)
    refused = pyqtSignal(int, str)

    def __init__(self, desk: Desk, thumbnails: Thumbnails, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._thumbnails = thumbnails
        self._was_connected = False
        self._pages: set[str] = set()
        self._reviews: dict[str, int] = {}
        self._image: tuple[str, int] | None = None
        self._without: set[int] = set()
        desk.link_changed.connect(self._link_changed)
        desk.answered.connect(self._answered)
        desk.observations_changed.connect(self._observations_changed)
        desk.site_changed.connect(self._site_changed)
        thumbnails.failed.connect(self._without.add)

    def review(self, request: ReviewObservation) -> None:
        """Tell the gateway what became of an observation; raises NotSentError when that cannot be sent."""
        self._reviews[self._desk.inquire(request)] = request.observation

    def is_asked(self, number: int) -> bool:
        """Tell whether a review of this observation is on its way."""
        return number in self._reviews.values()

    def _link_changed(self) -> None:
        connected = self._desk.link.phase is Phase.CONNECTED
        if connected and not self._was_connected:
            self._without.clear()
            self._ask_page(GetObservations(state=ObservationState.PENDING, limit=PAGE))
            self._ask_page(GetObservations(limit=REVIEWED))
        if not connected:
            self._image = None
        self._was_connected = connected

    def _ask_page(self, request: GetObservations) -> None:
        try:
            self._pages.add(self._desk.inquire(request))
        except FleetError:
            # The link is down again: all is asked anew when it is back.
            self._pages.clear()

    def _answered(self, answer: Answer) -> None:
        key = answer.order.key
        if key in self._pages:
            self._pages.discard(key)
            self._take_page(answer)
        elif self._image is not None and key == self._image[0]:
            number, self._image = self._image[1], None
            self._take_image(number, answer)
        elif key in self._reviews:
            number = self._reviews.pop(key)
            if answer.error is None:
                self.reviewed.emit(number)
            else:
                self.refused.emit(number, answer.error)

    def _take_page(self, answer: Answer) -> None:
        if answer.error is not None:
            if self._desk.link.phase is Phase.CONNECTED:
                self._desk.complained.emit(tr("What robots saw is not known: {error}", error=answer.error))
            return
        found = (answer.result or {}).get("observations") or []
        if len(found) == PAGE:
            before = found[-1]["observation"]
            self._ask_page(GetObservations(state=ObservationState.PENDING, before=before, limit=PAGE))
        self._fetch_image()

    def _take_image(self, number: int, answer: Answer) -> None:
        if answer.error is not None or not self._thumbnails.make(number, answer.result or {}):
            self._without.add(number)
        self._fetch_image()

    def _observations_changed(self, _numbers: list[int]) -> None:
        # The book forgets those that were reviewed long ago, and a picture is a file of up to 0.2 MB.
        known = {one.observation for one in self._desk.observations}
        self._thumbnails.keep(known)
        self._without &= known
        self._fetch_image()

    def _fetch_image(self) -> None:
        """Ask for the next image that is not there yet, when no other is on its way."""
        if self._image is not None or self._desk.link.phase is not Phase.CONNECTED:
            return
        wanted = next(
            (one.observation for one in self._desk.observations.ordered() if self._lacks(one)), None
        )
        if wanted is None:
            return
        try:
            self._image = self._desk.inquire(GetImage(wanted)), wanted
        except FleetError:
            self._image = None

    def _lacks(self, report: ObservationReport) -> bool:
        number = report.observation
        return (
            report.media_type is not None and number not in self._without and not self._thumbnails.has(number)
        )

    def _site_changed(self) -> None:
        if not len(self._desk.observations):
            self._thumbnails.clear()
            self._without.clear()
