"""``robot-bridge doctor``: checks of everything that a gateway needs on this computer, with remedies."""

from __future__ import annotations

import asyncio
import datetime
import http.client
import importlib.util
import resource
import shutil
import ssl
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from ..core.clock import SYSTEM_CLOCK
from ..core.errors import BridgeError, SiteError, StoreError, counted
from ..core.json_decoder import JsonBounds, decode_json
from ..core.logs import set_up_log
from ..core.sites.site_database import is_database_address
from .options import BusPasswordFileOption, DatabaseOption, PasswordFileOption, SiteOption
from .serve import cluster_settings, gateway_settings

if TYPE_CHECKING:
    from ..core.sites.site import Site
    from ..gateway.app import GatewaySettings

LEAST_FREE, FEW_FREE = 100e6, 1e9
"""Free bytes on the disk below which storing may fail, and below which somebody must act."""
MOST_OFF_S = 2.0
"""Seconds that this computer's clock may be off the database's."""
ANSWER_WITHIN = 5.0
"""Seconds for a running gateway, and for a program of the system, to answer."""
HEALTH_PAGE = JsonBounds(depth=8, length=1 << 20, values=10_000)
"""Limits of a gateway's health page."""


class Level(StrEnum):
    """The result of a check; with a fault the gateway does not start, or does not work."""

    OK = "ok"
    WARNING = "warning"
    FAULT = "FAULT"


class Finding(NamedTuple):
    """The finding of a check in one line; with the remedy unless all is well."""

    level: Level
    subject: str
    text: str


def doctor(
    site: SiteOption,
    database: DatabaseOption = "",
    database_password_file: PasswordFileOption = None,
    host: Annotated[
        str, typer.Option(help="Address that the gateway listens on.", envvar="ROBOT_BRIDGE_HOST")
    ] = "",
    port: Annotated[int | None, typer.Option(help="Port that it listens on.", min=1, max=65535)] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(help="The gateway's certificate (PEM).", envvar="ROBOT_BRIDGE_CERTIFICATE"),
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its key (PEM).", envvar="ROBOT_BRIDGE_KEY")] = None,
    gateway_name: Annotated[
        str,
        typer.Option(
            help="Its name, where several serve one fleet.",
            envvar="ROBOT_BRIDGE_GATEWAY_NAME",
        ),
    ] = "",
    bus: Annotated[str, typer.Option(help="What those tell each other by.", envvar="ROBOT_BRIDGE_BUS")] = "",
    bus_password_file: BusPasswordFileOption = None,
    public_address: Annotated[
        str,
        typer.Option(help="Where robots reach this gateway.", envvar="ROBOT_BRIDGE_PUBLIC_ADDRESS"),
    ] = "",
) -> None:
    """Check what a gateway needs on this computer, and say what to do.

    Give it the options of serve. It changes nothing; status 1 says that the gateway cannot do its work.
    """
    # Each finding is printed once.
    set_up_log("text", "error")
    worst = Level.OK
    # A site in a database is fetched, but not to the place of a gateway's copy.
    with TemporaryDirectory(prefix="robot-bridge-") as folder:
        state = Path(folder) if is_database_address(site) else None
        given = (database, database_password_file, host, port, certificate, key)
        settings = gateway_settings(site, state, *given)
        cluster = cluster_settings(settings.site, gateway_name, bus, bus_password_file, public_address)
        for finding in findings(replace(settings, cluster=cluster)):
            typer.echo(f"{finding.level:<8} {finding.subject:<12} {finding.text}")
            worst = finding.level if finding.level is Level.FAULT else worst
    if worst is Level.FAULT:
        raise typer.Exit(1)


def findings(settings: GatewaySettings) -> Iterator[Finding]:
    """Yield the findings of each check; no check prevents another."""
    checks: dict[str, Callable[[GatewaySettings], Iterator[Finding]]] = {
        "site": _check_site,
        "database": _check_database,
        "gateways": _check_gateways,
        "bus": _check_bus,
        "certificate": _check_certificate,
        "reach": _check_reach,
        "disk": _check_disk,
        "clock": _check_clock,
        "packages": _check_packages,
        "gateway": _check_gateway,
    }
    for subject, check in checks.items():
        try:
            yield from check(settings)
        except (BridgeError, SiteError, OSError) as error:
            yield Finding(Level.FAULT, subject, str(error))


def _check_site(settings: GatewaySettings) -> Iterator[Finding]:
    from ..core.sites.site import read_site
    from ..links.kinds import load

    site = read_site(settings.site)
    version = f"{site.name}, version {site.version}, {counted(len(site.outlines), 'obstacle')}"
    yield Finding(Level.OK, "site", f"{settings.site}: {version}")
    yield _open_files(site)
    for kind, name in site.settings.links.files():
        try:
            load(kind, settings.site / name)
        except (BridgeError, SiteError, OSError) as error:
            yield Finding(Level.FAULT, "link", str(error))
        else:
            yield Finding(Level.OK, "link", f"{name}: {kind}")


def _open_files(site: Site) -> Finding:
    from ..gateway.auth.port import files_needed

    needed, most = files_needed(site.settings.limits), resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    if most != resource.RLIM_INFINITY and most < needed:
        text = f"{most} may be open, and the site's limits take {needed}: raise LimitNOFILE of the service"
        return Finding(Level.WARNING, "open files", text)
    return Finding(Level.OK, "open files", f"{needed} may be needed, and be opened")


def _check_database(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.storage import revisions
    from ..gateway.storage.database import run_once, shown
    from ..gateway.storage.dialects import sqlite_path_in

    place, file = shown(settings.database), sqlite_path_in(settings.database)
    if file is not None and not file.is_file():
        yield Finding(Level.WARNING, "database", f"{place} is not there: the gateway makes it when it starts")
        return
    report = run_once(settings.database, revisions.report)
    if report.good:
        yield Finding(Level.OK, "database", f"{place}: revision {report.found}")
        return
    yield Finding(Level.FAULT, "database", f"{place}: {'; '.join((*report.differences, report.advice))}")


def _check_gateways(settings: GatewaySettings) -> Iterator[Finding]:
    """Check, for several gateways, that each is alive, with the same version and clock."""
    from ..gateway.monitoring import gateway_version
    from ..gateway.storage.database import run_once
    from ..gateway.storage.repositories import gateways

    if settings.cluster is not None:
        settings.cluster.check_gateway(settings.database)
    if settings.database.get_backend_name() != "postgresql":
        return
    try:
        found = run_once(settings.database, gateways.read_members, SYSTEM_CLOCK)
    except StoreError:
        # The check of the database reports this.
        return
    own = gateway_version()
    for one in found.members:
        where = f"{one.gw}: process {one.process} on {one.host}"
        if not one.alive:
            text = (
                f"{where} has not renewed its lease for {-one.left:.0f} s: see whether it runs, and start it"
            )
            yield Finding(Level.WARNING, "gateways", text)
        elif one.version != own:
            text = f"{where} is version {one.version}, and this is {own}: bring all to one version"
            yield Finding(Level.WARNING, "gateways", text)
        else:
            yield Finding(
                Level.OK, "gateways", f"{where}, version {one.version}, at {one.address or 'no address'}"
            )
    if abs(off := found.database - found.here) > MOST_OFF_S:
        text = f"this computer's is {abs(off):.0f} s off the database's: let NTP set both"
        yield Finding(Level.WARNING, "clock", text)


def _check_bus(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.storage.database import run_once
    from ..gateway.storage.repositories import metadata

    cluster = settings.cluster
    if cluster is None:
        return
    cluster.check_bus()
    if not cluster.servers():
        yield Finding(Level.OK, "bus", cluster.bus)
        return
    try:
        fleet = run_once(settings.database, metadata.known_fleet)
    except StoreError:
        fleet = None
    if fleet is None:
        text = "what its account may do is checked once a gateway has served this database"
        yield Finding(Level.WARNING, "bus", text)
        return
    asyncio.run(cluster.nats_bus(fleet).check())
    yield Finding(Level.OK, "bus", f"NATS takes and hands over what is said on fleet.{fleet}.>")


def _check_certificate(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.auth.port import WARN_DAYS, ServerTls

    if settings.tls is None:
        yield Finding(Level.OK, "certificate", "none: ws://, for this computer only")
        return
    file, tls = settings.tls.certificate, ServerTls(settings.tls)
    left = (tls.until - datetime.datetime.now(datetime.timezone.utc)).days
    text = f"{file}: for {', '.join(tls.names)}, until {tls.until:%Y-%m-%d}"
    if left >= WARN_DAYS:
        yield Finding(Level.OK, "certificate", text)
        return
    level = Level.WARNING if left >= 0 else Level.FAULT
    yield Finding(level, "certificate", f"{text}: make a new one with 'robot-bridge tls renew {file.parent}'")


def _check_reach(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.auth.accounts import grants, has_operator
    from ..gateway.auth.port import check_reach, is_loopback
    from ..gateway.storage.database import run_once
    from ..gateway.storage.dialects import sqlite_path_in

    if is_loopback(settings.host):
        yield Finding(Level.OK, "reach", f"{settings.host}: nobody beyond this computer")
        return
    # Without TLS the database need not be queried for accounts.
    check_reach(settings.host, tls=settings.tls is not None, accounts=True)
    file = sqlite_path_in(settings.database)
    is_new = file is not None and not file.is_file()
    known = [] if is_new else run_once(settings.database, grants)
    check_reach(settings.host, tls=True, accounts=has_operator(known, time.time()))
    yield Finding(Level.OK, "reach", f"{settings.host}: other computers, with TLS and accounts")


def _check_disk(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.storage.dialects import sqlite_path_in

    folders = {settings.state or settings.site.absolute().parent}
    if (file := sqlite_path_in(settings.database)) is not None:
        folders.add(file.absolute().parent)
    for folder in sorted(folders):
        free = shutil.disk_usage(folder).free
        level = Level.FAULT if free < LEAST_FREE else Level.WARNING if free < FEW_FREE else Level.OK
        advice = "" if level is Level.OK else ": free some, or keep trajectories for fewer days (site.toml)"
        yield Finding(level, "disk", f"{folder}: {free / 1e9:.1f} GB free{advice}")


def _check_clock(settings: GatewaySettings) -> Iterator[Finding]:
    program = shutil.which("timedatectl")
    command = [program or "", "show", "--property=NTPSynchronized", "--value"]
    try:
        # Without systemd it fails, and the state is unknown.
        done = subprocess.run(  # nosec B603 # our own words, no shell
            command, capture_output=True, text=True, check=False, timeout=ANSWER_WITHIN
        )
        synchronised = done.stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        synchronised = ""
    if synchronised == "yes":
        yield Finding(Level.OK, "clock", "set by a time server")
    elif synchronised == "no":
        text = "not set by a time server: install chrony, or times in reports and of robots will differ"
        yield Finding(Level.WARNING, "clock", text)
    else:
        yield Finding(Level.WARNING, "clock", "whether a time server sets it is not known here: no systemd")


def _check_packages(settings: GatewaySettings) -> Iterator[Finding]:
    missing = {
        "uvloop": ("speed", "the gateway takes twice the processor time"),
        "routingkit_cch": ("routes", "routes on large road networks take longer"),
    }
    for package, (extra, consequence) in missing.items():
        if importlib.util.find_spec(package) is None:
            advice = f"pip install 'fleet-supervisor-robot-bridge[{extra}]'"
            yield Finding(Level.WARNING, "packages", f"without {package} {consequence}: {advice}")
            return
    yield Finding(Level.OK, "packages", f"Python {sys.version.split()[0]}, with all that makes it quick")


def _check_gateway(settings: GatewaySettings) -> Iterator[Finding]:
    from ..gateway.api.metrics_and_queries import HEALTH
    from ..gateway.auth.port import address_here

    host = address_here(settings.host)
    where = f"{host}:{settings.port}"
    connect: Callable[..., http.client.HTTPConnection] = http.client.HTTPConnection
    if settings.tls is not None:
        # It is this computer that is contacted; whether others can trust the certificate is checked above.
        connect = partial(http.client.HTTPSConnection, context=ssl._create_unverified_context())  # nosec B323 # itself
    connection = connect(host, settings.port, timeout=ANSWER_WITHIN)
    try:
        connection.request("GET", HEALTH)
        health = decode_json(connection.getresponse().read(HEALTH_PAGE.length), HEALTH_PAGE)
        failing = [name for name, one in health.items() if isinstance(one, dict) and one.get("ok") is False]
        summary = f"version {health['version']}, site {health['site']['id']}"
    except ConnectionRefusedError:
        yield Finding(Level.WARNING, "gateway", f"none runs at {where}: start it with 'robot-bridge serve'")
        return
    except (OSError, http.client.HTTPException, ValueError, KeyError, TypeError, AttributeError) as error:
        text = f"what listens at {where} does not answer as a gateway ({error!r}): end it, or take --port"
        yield Finding(Level.FAULT, "gateway", text)
        return
    finally:
        connection.close()
    down = [name for name, link in health.get("links", {}).items() if not link["ok"]]
    if down:
        yield Finding(Level.WARNING, "gateway", f"{where}: links that are down: {', '.join(down)}")
    buses: dict[str, bool] = health.get("cluster", {}).get("buses", {})
    if away := [name for name, up in buses.items() if not up]:
        text = f"{where}: not connected to the bus {' and '.join(away)}: its log says why"
        yield Finding(Level.WARNING, "gateway", text)
    if problem := health["site"].get("text"):
        yield Finding(Level.FAULT, "gateway", f"{where}: {problem}")
    if failing:
        text = f"{where}: {', '.join(failing)} failing: journalctl -u robot-bridge says why"
        yield Finding(Level.FAULT, "gateway", text)
    else:
        yield Finding(Level.OK, "gateway", f"{where}: {summary}")
