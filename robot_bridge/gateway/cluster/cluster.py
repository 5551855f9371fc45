"""Cluster: one gateway's part in a fleet that several serve, with its background tasks."""

from __future__ import annotations

import logging
import secrets
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from sqlalchemy import URL, Connection, text

from ...core.errors import BridgeError
from ...core.messages.base import LONGEST_ADDRESS, is_gateway_address
from ..storage.database import Database
from ..storage.repositories import gateways, metadata
from .bus import LARGEST_NOTIFICATION, Bus, NoBus, NotifyBus
from .membership import LEASE_PATIENCE_S, Membership, check_gateway_name
from .messages import LARGEST, Exchange
from .nats_bus import NatsBus
from .nats_servers import nats_urls
from .ownership import Ownership

log = logging.getLogger(__name__)

LONGEST_PUBLIC = LONGEST_ADDRESS - 16
"""characters of an address; an endpoint's path is appended in the form sent to robots."""
BUSES = "none, postgresql, or nats://HOST:PORT (several with commas between them; tls:// with TLS)"


@dataclass(frozen=True)
class ClusterSettings:
    """The name of a gateway among those that serve one fleet, and the bus between them.

    ``bus`` is ``none``, ``postgresql``, or the URLs of NATS servers with commas between them; ``password``
    belongs to the account in those. ``stops_when_cut_off``: whether this gateway's robots stop when it
    reaches neither the database nor any other gateway. ``public_address`` is where robots reach it, such as
    ``wss://north.example.org:8765``; None for the address that it listens on.
    """

    name: str
    bus: str = "postgresql"
    password: str | None = None
    stops_when_cut_off: bool = True
    public_address: str | None = None

    def check(self, database: URL) -> None:
        """Raise BridgeError for invalid settings."""
        self.check_gateway(database)
        self.check_bus()

    def check_gateway(self, database: URL) -> None:
        """Raise BridgeError for an invalid name, database or address."""
        check_gateway_name(self.name)
        if database.get_backend_name() != "postgresql":
            raise BridgeError(
                f"several gateways serve one fleet on PostgreSQL only, and this database is "
                f"{database.get_backend_name()}: give --database postgresql://..., or leave out "
                "--gateway-name to serve it with this gateway alone"
            )
        address = self.public_address
        if address is not None and not (is_gateway_address(address) and len(address) <= LONGEST_PUBLIC):
            raise BridgeError(
                f"public address {address!r:.80} cannot be sent to robots; write it as ws://HOST:PORT or "
                f"wss://HOST:PORT, with a path if robots need one, at most {LONGEST_PUBLIC} characters"
            )

    def check_bus(self) -> None:
        """Raise BridgeError for an invalid bus, or a password without use."""
        if self.bus not in ("none", "postgresql") and not self.servers():
            raise BridgeError(f"bus {self.bus!r:.80} is none of these: {BUSES}")
        if self.password is not None and not (
            self.servers() and all(urlsplit(url).username for url in self.servers())
        ):
            raise BridgeError(
                "--bus-password-file is for the account of a bus on NATS: name that in each URL, as in "
                "nats://ACCOUNT@HOST:PORT, or leave the file out"
            )

    def servers(self) -> list[str]:
        """Return the URLs of NATS servers, none for another bus or an invalid URL."""
        return nats_urls(self.bus)

    def nats_bus(self, fleet: str) -> NatsBus:
        """Return the bus of the fleet named ``fleet`` on the NATS servers; raises BridgeError."""
        return NatsBus(self.servers(), self.name, f"fleet.{fleet}", self.password)


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

    def listens(self, address: str, *, everywhere: bool) -> None:
        """Record that this gateway listens on ``address``; if ``everywhere``, it is not one to connect to."""
        if self.settings.public_address is not None:
            self.membership.reached_at(self.settings.public_address.rstrip("/"))
        elif not everywhere:
            self.membership.reached_at(address)
        else:
            self.membership.reached_at("")
            log.warning(
                "gateway %s listens on all addresses and does not know by which one robots reach it; they "
                "are not told of it unless you give --public-address wss://HOST:PORT",
                self.settings.name,
            )

    def report(self) -> dict[str, Any]:
        """Return the states of the fleet's gateways, as far as this one knows."""
        membership, heard = self.membership, set(self.exchange.heard())
        others = [member for member in membership.members if member.gw != membership.name]
        return {
            "gateway": membership.name,
            "lease": membership.trust.holds,
            "leads": membership.leads,
            "clock_offset_s": round(membership.clock_offset, 3),
            "buses": self.exchange.connections(),
            "others": {
                member.gw: {
                    "lease": member.alive,
                    "heard": member.gw in heard,
                    "version": member.version,
                    "host": member.host,
                    "process": member.process,
                }
                for member in others
            },
        }

    @property
    def largest_message(self) -> int:
        """Largest message of the bus in bytes; it may have to fit into a notification."""
        return LARGEST_NOTIFICATION if self.settings.bus == "postgresql" else LARGEST


KEY = "bus_key"
"""The database fact that holds the secret for signing messages."""
PLACE = "place"
"""The database fact that names the database and its server; a copy has that of the original."""
_HERE = text(
    "select (select system_identifier from pg_control_system()) || '/' || oid from pg_database "
    "where datname = current_database() and has_function_privilege('pg_control_system()', 'execute')"
)


def fleet_id(connection: Connection) -> str:
    """Return the id of the fleet on this database; a copy of another database gets its own id and key.

    Two fleets of one id and key that share a bus would receive each other's stops, and count each other's
    answers. Nothing changes while a gateway lives: it knows the old values.
    """
    here = connection.scalar(_HERE)
    if here is not None and (before := metadata.fact(connection, PLACE, here)) != here:
        is_served = any(member.alive for member in gateways.members(connection))
        if not is_served and metadata.replace_fact(connection, PLACE, before, here):
            metadata.forget_facts(connection, [metadata.FLEET, KEY])
            metadata.renew_id(connection, metadata.database_id(connection))
            log.warning(
                "this database is a copy of another one, or was moved: from now on it is fleet %s, which the "
                "account on a NATS server has to be allowed",
                id := metadata.fleet_id(connection),
            )
            return id
    return metadata.fleet_id(connection)


def fleet_key(connection: Connection) -> bytes:
    """Return the secret of the fleet on this database; create it if missing."""
    return bytes.fromhex(metadata.fact(connection, KEY, secrets.token_hex(32)))


async def join_cluster(settings: ClusterSettings, database: Database, lease: Database, fleet: str) -> Cluster:
    """Enter the fleet named ``fleet`` on ``database``; ``lease`` is a connection of its own for the lease.

    :raises BridgeError: when the bus cannot be used, or the name is another gateway's; StoreError.
    """
    buses: list[Bus] = []
    notify = NotifyBus(database.url, settings.name)
    if settings.servers():
        nats = settings.nats_bus(fleet)
        await nats.check()
        # Stops and wakes go over both: each is enough.
        buses = [nats, notify]
    else:
        buses = [notify] if settings.bus == "postgresql" else [NoBus()]
    key = await database.run(fleet_key)
    membership = Membership(settings.name, lease)
    await membership.join()
    exchange = Exchange(settings.name, key, buses, membership)
    return Cluster(settings, membership, Ownership(membership, database), exchange, lease)


def lease_database(url: URL) -> Database:
    """Return the connection by which a gateway renews its lease, and polls for stops."""
    return Database(url, patience=LEASE_PATIENCE_S)
