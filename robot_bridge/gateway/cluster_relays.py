"""Relays between the gateways of a fleet, assembled on the fleet of this one."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping

from .cluster.cluster import Cluster
from .cluster.feeds import ObservationRelay, PlacementRelay, QueueFeed, StepFeed
from .cluster.followers import ChangeNumbers, Followed, Follower
from .cluster.messages import Wake
from .cluster.request_relay import RequestRelay
from .cluster.robot_relay import DetailRelay, FenceRelay, PositionRelay
from .cluster.stop_relay import EmergencyStopRelay
from .fleet.link_supervision import SUSPEND_INTERVAL
from .fleet.service import Fleet
from .model.events import Answering, ClosuresChanged, PlanChanged, SiteChosen
from .monitoring import Counters, Work, every, until_tick, wait_at_most
from .storage.database import Database

BEAT_INTERVAL_S = 1.0
OWNERS_INTERVAL_S = 1.0
ADDRESSES_INTERVAL_S = 1.0
FORGET_INTERVAL_S = 600.0
LEADER_LOOK_S = 0.25
ONCE_PER_DATABASE = ("sql link", "links", "prune", "stuck robots")
"""Works that the leader does for all gateways."""


class ClusterRelays:
    """The additional works of a gateway that is one of several."""

    def __init__(
        self,
        cluster: Cluster,
        fleet: Fleet,
        handlers: Answering,
        lease: Database,
        sites: Followed,
        plans: Followed,
        *,
        stops_when_cut_off: bool,
    ) -> None:
        membership, exchange, database = cluster.membership, cluster.exchange, fleet.database
        largest = cluster.largest_message
        self._cluster = cluster
        self._fleet = fleet
        self.stops = EmergencyStopRelay(
            fleet.emergency, membership, exchange, lease, stops_when_cut_off=stops_when_cut_off
        )
        fleet.emergency.relay_by(self.stops)
        assert fleet.aborts is not None
        own = fleet.queue_context.commands.drafting
        self.requests = RequestRelay(
            handlers, fleet.robots, membership, exchange, database, fleet.aborts, own
        )
        self._aborts = fleet.aborts
        self._positions = PositionRelay(fleet.robots, membership, exchange, largest)
        self._details = DetailRelay(fleet.robots, membership, exchange, largest)
        self._fences = FenceRelay(membership, exchange, fleet.events, largest)
        self._numbers = ChangeNumbers(exchange, membership)
        shared = fleet.listeners, fleet.events, exchange, self._numbers, database
        self._steps = StepFeed(fleet.robots, *shared)
        self._queues = QueueFeed(fleet.robots, fleet.queue_context.registry, *shared)
        self._placements = PlacementRelay(*shared)
        self._observations = ObservationRelay(fleet.observations, *shared)
        self._sites = Follower("site", sites, exchange, self._numbers)
        fleet.events.subscribe(SiteChosen, lambda _: self._sites.note_change())
        self._plans = Follower("plans", plans, exchange, self._numbers)
        fleet.events.subscribe(PlanChanged, lambda _: self._plans.note_change())
        self._closures = Follower("closures", fleet.roads.closures, exchange, self._numbers)
        fleet.events.subscribe(ClosuresChanged, lambda _: self._closures.note_change())
        self._owners_changed = asyncio.Event()
        exchange.subscribe(Wake, self._woken)

    def reach(self, link: Callable[[str, str], bool]) -> None:
        """Call ``link`` with a robot and the id of a call when another gateway aborts it directly."""
        self.requests.reach(link)

    def works(self, works: Mapping[str, Work], counters: Counters) -> dict[str, Work]:
        """Return ``works`` of a gateway adapted to one of several, with the additional ones."""
        if "suspensions" in works:
            works = {
                **works,
                "suspensions": lambda: every(SUSPEND_INTERVAL, self._suspend, "suspensions", counters),
            }
        once = {name: self._led(name, works[name], counters) for name in ONCE_PER_DATABASE if name in works}
        return {
            **works,
            **once,
            "bus": self._cluster.exchange.run,
            "stops of others": self.stops.run,
            "aborts of others": self._aborts.run,
            "beat": self._beat,
            "owners": self._follow_owners,
            "requests of others": self.requests.run,
            "steps of others": self._steps.run,
            "positions of others": self._positions.run,
            "details of others": self._details.run,
            "queues of others": self._queues.run,
            "observations of others": self._observations.run,
            "placements of others": self._placements.run,
            "plans": self._plans.run,
            "site of others": self._sites.run,
            "closures of others": self._closures.run,
            "addresses": lambda: every(
                ADDRESSES_INTERVAL_S, self._fleet.announce_gateways, "addresses", counters
            ),
            "old requests": self._led(
                "old requests",
                lambda: every(FORGET_INTERVAL_S, self._forget_old, "old requests", counters),
                counters,
            ),
        }

    async def _beat(self) -> None:
        """Send heartbeats to other gateways, independent of all other work."""
        while True:
            self._numbers.send_beat()
            await asyncio.sleep(until_tick(BEAT_INTERVAL_S))

    async def _suspend(self) -> None:
        """Read the suspended accounts, and update them while this gateway leads."""
        await self._fleet.suspensions.follow()
        if self._cluster.membership.leads:
            await self._fleet.suspensions.update()
        else:
            # Robots on SQL are the leader's: what others wait for is an offence of the moment.
            self._fleet.database.offences.drain()

    async def _forget_old(self) -> None:
        await self.requests.forget()
        await self._cluster.membership.strike_gone()

    async def _follow_owners(self) -> None:
        takeover = self._fleet.takeover
        assert takeover is not None
        while True:
            self._owners_changed.clear()
            await takeover.claim_left()
            await takeover.follow()
            await wait_at_most(self._owners_changed, until_tick(OWNERS_INTERVAL_S))

    def _woken(self, wake: Wake) -> None:
        if wake.what == "owners":
            self._owners_changed.set()

    def _led(self, name: str, work: Work, counters: Counters) -> Work:
        """Return a coroutine function that runs ``work`` only while this gateway leads."""

        async def led() -> None:
            membership = self._cluster.membership
            while True:
                while not membership.leads:
                    # Work done by another gateway counts as done.
                    counters.beat(name)
                    await asyncio.sleep(until_tick(LEADER_LOOK_S))
                task = asyncio.ensure_future(work())
                try:
                    while membership.leads and not task.done():
                        await asyncio.wait({task}, timeout=until_tick(LEADER_LOOK_S))
                    if task.done():
                        return task.result()
                finally:
                    task.cancel()
                    await asyncio.gather(task, return_exceptions=True)

        return led
