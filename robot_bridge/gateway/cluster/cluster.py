"""Cluster: one gateway's part in a fleet that several serve, put together and kept going."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import URL

from ...core.errors import BridgeError
from ..storage.database import Database
from .bus import Bus, NatsBus, NoBus, NotifyBus
from .exchange import Exchange, fleet_key
from .leases import check_gateway_name
from .membership import LEASE_PATIENCE_S, Membership
from .ownership import Ownership

BUSES = "none, postgresql, or nats://HOST:PORT (several with commas between them; tls:// with TLS)"


@dataclass(frozen=True)
class ClusterSettings:
    """The name of a gateway among those that serve one fleet, and the bus between them.

    ``bus`` is ``none``, ``postgresql``, or the URLs of NATS servers with commas between them; ``password`` is
    that of the account in those. ``stops_when_cut_off``: whether the robots of this gateway stop when it
    reaches neither the database nor any other gateway.
    """

    name: str
    bus: str = "postgresql"
    password: str | None = None
    stops_when_cut_off: bool = True

    def check(self, database: URL) -> None:
        """Raise BridgeError for what cannot be."""
        check_gateway_name(self.name)
        if database.get_backend_name() != "postgresql":
            raise BridgeError(
                f"several gateways serve one fleet on PostgreSQL only, and this database is "
                f"{database.get_backend_name()}: give --database postgresql://..., or leave out "
                "--gateway-name to serve it with this gateway alone"
            )
        if self.bus not in ("none", "postgresql") and not self.servers():
            raise BridgeError(f"bus {self.bus!r:.80} is none of these: {BUSES}")

    def servers(self) -> list[str]:
        """Return the URLs of NATS servers, none for another bus or for what is no such URL."""
        urls = [url.strip() for url in self.bus.split(",")]
        return urls if all(url.startswith(("nats://", "tls://")) for url in urls) else []


class Cluster:
    """Membership, the robots of this gateway, and the exchange with others."""

    def __init__(
        self,
        settings: ClusterSettings,
        membership: Membership,
        ownership: Ownership,
        exchange: Exchange,
        lease: Database,
    ) -> None:
        self.settings = settings
        self.membership = membership
        self.ownership = ownership
        self.exchange = exchange
        self.lease = lease

    @property
    def has_small_messages(self) -> bool:
        """Whether what is sent has to fit into notifications of PostgreSQL."""
        return self.settings.bus == "postgresql"


async def join_cluster(settings: ClusterSettings, database: Database, lease: Database, fleet: str) -> Cluster:
    """Enter the fleet named ``fleet`` on ``database``; ``lease`` is a connection of its own for the lease.

    :raises BridgeError: when the bus cannot be used, or the name is another gateway's; StoreError.
    """
    buses: list[Bus] = []
    notify = NotifyBus(database.url, settings.name)
    if servers := settings.servers():
        nats = NatsBus(servers, settings.name, f"fleet.{fleet}", settings.password)
        await nats.check()
        # Stops and wakes go both ways: each is enough.
        buses = [nats, notify]
    else:
        buses = [notify] if settings.bus == "postgresql" else [NoBus()]
    key = await database.run(fleet_key)
    membership = Membership(settings.name, lease)
    await membership.join()
    exchange = Exchange(settings.name, key, buses)
    return Cluster(settings, membership, Ownership(membership, database), exchange, lease)


def lease_database(url: URL) -> Database:
    """Return the connection by which a gateway renews its lease, and looks for stops."""
    return Database(url, patience=LEASE_PATIENCE_S)
