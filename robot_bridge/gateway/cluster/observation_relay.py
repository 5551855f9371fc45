"""Observations at other gateways: drawn onto the maps of this one, and told to its operators."""

from __future__ import annotations

from typing import Protocol

from ...core.errors import StoreError
from ...core.messages.json_values import to_json
from ...core.messages.records import ObservationReport, ObservationState
from ..model.events import EventBus, Listeners, ObservationChanged
from ..storage.database import Database
from ..storage.repositories import records
from ..storage.repositories.records import ObservationChanges
from .exchange import Exchange
from .follower import Follower

NEWEST = 200
"""observations whose changes operators are told: of older ones those alone that are on the maps."""


class ObservedMaps(Protocol):
    """The maps that accepted objects are drawn on."""

    async def redraw(self) -> None:
        """Draw what is accepted by now; raises StoreError."""


class ObservationRelay:
    """Follows what robots of other gateways saw and operators there accepted, and wakes others."""

    def __init__(
        self,
        maps: ObservedMaps,
        listeners: Listeners,
        events: EventBus,
        exchange: Exchange,
        database: Database,
    ) -> None:
        self._maps = maps
        self._listeners = listeners
        self._database = database
        self._known: ObservationChanges | None = None
        self._told: dict[int, ObservationReport] = {}
        """what the operators of this gateway heard of the newest."""
        self._reviewed_here = False
        """whether the maps may show what was reviewed here since the last look, and is otherwise by now."""
        self._follower = Follower("observations", self, exchange)
        events.subscribe(ObservationChanged, self._note)

    async def run(self) -> None:
        """Follow until cancelled; raises StoreError."""
        await self._follower.run()

    async def follow(self) -> None:
        """Draw and tell what has changed since the last look; raises StoreError."""
        found = await self._database.read(records.changes, NEWEST)
        before = self._known
        if before is None or self._reviewed_here or found.on_map != before.on_map:
            self._reviewed_here = False
            try:
                await self._maps.redraw()
            except StoreError:
                self._reviewed_here = True
                raise
        if before is not None:
            changed = [id for id, version in found.newest.items() if before.newest.get(id) != version]
            for report in await self._database.read(records.find_each, changed) if changed else []:
                self._tell(report)
        self._told = {id: report for id, report in self._told.items() if id in found.newest}
        self._known = found

    def _tell(self, report: ObservationReport) -> None:
        if self._told.get(report.observation) != report:
            self._told[report.observation] = report
            self._listeners.announce("observation", str(report.observation), to_json(report))

    def _note(self, changed: ObservationChanged) -> None:
        self._told[changed.report.observation] = changed.report
        self._reviewed_here |= changed.report.state is not ObservationState.PENDING
        self._follower.note_change()
