"""``robot-bridge serve``: the gateway as a program, from its options to its exit status."""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ..core.errors import BridgeError
from ..core.logs import LogFormat, LogLevel, finish_writing, set_up_server_log
from ..core.systemd import call_at_end_of_input, notify, watchdog_interval
from ..gateway.monitoring import freeze_permanent_objects
from . import options

if TYPE_CHECKING:
    from ..gateway.app import GatewaySettings, Signals
    from ..gateway.cluster.cluster import ClusterSettings

log = logging.getLogger(__name__)

HOST, PORT = "127.0.0.1", 8765
SWITCH_INTERVAL_S = 0.0005
LAST_MOMENT = 4.7
"""seconds after which a gateway that must end does so, whatever it waits for."""
LAST_WORDS = 0.2
"""seconds in which it writes that."""

Loop = Literal["auto", "uvloop", "asyncio"]


def serve(
    site: options.SiteOption,
    database: options.DatabaseOption = "",
    database_password_file: options.PasswordFileOption = None,
    host: Annotated[
        str,
        typer.Option(
            help=f"Address to listen on ({HOST}); beyond loopback with TLS and accounts.",
            envvar="ROBOT_BRIDGE_HOST",
        ),
    ] = "",
    port: Annotated[
        int | None, typer.Option(help=f"Port to listen on ({PORT}); 0 takes any.", min=0, max=65535)
    ] = None,
    certificate: Annotated[
        Path | None,
        typer.Option(help="The gateway's certificate (PEM), for wss://.", envvar="ROBOT_BRIDGE_CERTIFICATE"),
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its key (PEM).", envvar="ROBOT_BRIDGE_KEY")] = None,
    gateway_name: Annotated[
        str,
        typer.Option(
            help="Name of this gateway, where several serve one fleet on one PostgreSQL database.",
            envvar="ROBOT_BRIDGE_GATEWAY_NAME",
        ),
    ] = "",
    bus: Annotated[
        str,
        typer.Option(
            help="What gateways with names tell each other by: postgresql, none, or nats://HOST:PORT, "
            "several with commas between them.",
            envvar="ROBOT_BRIDGE_BUS",
        ),
    ] = "",
    bus_password_file: options.BusPasswordFileOption = None,
    public_address: Annotated[
        str,
        typer.Option(
            help="Where robots reach this gateway, one of several, ws://HOST:PORT or wss://HOST:PORT; "
            "unless given, where it listens.",
            envvar="ROBOT_BRIDGE_PUBLIC_ADDRESS",
        ),
    ] = "",
    site_as_given: Annotated[
        bool,
        typer.Option("--site-as-given", help="Serve --site, whatever site a supervisor chose at a desk."),
    ] = False,
    state: Annotated[
        Path | None,
        typer.Option(
            help="Folder in which emergency stops are noted that are not in the database yet; unless given, "
            "the one that the site's folder lies in. With SQLite they are beside the database. The copy of a "
            "site in PostGIS is kept there, too.",
            envvar=["ROBOT_BRIDGE_STATE", "STATE_DIRECTORY"],
        ),
    ] = None,
    log_format: Annotated[
        LogFormat, typer.Option(help="Lines for people, or JSON.", envvar="ROBOT_BRIDGE_LOG_FORMAT")
    ] = "text",
    log_level: Annotated[
        LogLevel, typer.Option(help="The least that is logged.", envvar="ROBOT_BRIDGE_LOG_LEVEL")
    ] = "warning",
    loop: Annotated[Loop, typer.Option(help="Event loop; auto is uvloop where it is installed.")] = "auto",
    until_stdin_closes: options.UntilStdinCloses = False,
) -> None:
    """Serve one site to robots (/robot, and tables rr and sa) and to operators (/desk).

    What is not given is taken from table gateway of site.toml. SIGHUP reads the site anew.
    """
    gc.disable()
    from ..gateway import app  # noqa: F401 # loaded here, before loaded objects are frozen

    # All of it is permanent. Repeated garbage collection took a seventh of the start.
    gc.freeze()
    gc.enable()
    # Each write to a connection lets the database's thread have a turn, which is as long as this (5 ms unless
    # set): a stop of a thousand robots would wait for a thousand of them.
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    set_up_server_log(log_format, log_level)
    settings = gateway_settings(site, state, database, database_password_file, host, port, certificate, key)
    cluster = cluster_settings(settings.site, gateway_name, bus, bus_password_file, public_address)
    settings = replace(settings, site_as_given=site_as_given, cluster=cluster)
    # pyogrio imports it if installed, for a way of reading that a gateway does not use: 29 MB.
    sys.modules.setdefault("pyarrow", None)  # type: ignore[arg-type] # as Python documents it
    with asyncio.Runner(loop_factory=_loop_factory(loop)) as runner:
        runner.run(_serve(settings, until_stdin_closes))


def gateway_settings(
    site: str,
    state: Path | None,
    database: str,
    password_file: Path | None,
    host: str,
    port: int | None,
    certificate: Path | None,
    key: Path | None,
) -> GatewaySettings:
    """Return the settings of a gateway; missing options are taken from the site's settings.

    :raises BridgeError: for invalid settings, addresses or files.
    """
    from ..core.sites.settings import SETTINGS_FILE, read_settings
    from ..core.sites.settings_tables import GatewayOptions
    from ..gateway.app import GatewaySettings
    from ..gateway.auth.port import server_files

    copy = options.site_copy(site, state)
    folder = Path(site) if copy is None else copy.folder
    # A missing folder is reported when the whole site is read.
    given = read_settings(folder / SETTINGS_FILE).gateway if folder.is_dir() else GatewayOptions()
    files = (certificate or _beside(folder, given.certificate), key or _beside(folder, given.key))
    return GatewaySettings(
        site=folder,
        database=options.database_address(database or given.database or options.DEFAULT, password_file),
        host=host or given.host or HOST,
        port=next(number for number in (port, given.port, PORT) if number is not None),
        tls=server_files(*files),
        state=state,
        site_copy=copy,
    )


def cluster_settings(
    site: Path, name: str, bus: str, password_file: Path | None, public_address: str = ""
) -> ClusterSettings | None:
    """Return the settings of a gateway among several, None for one that has its database alone.

    :raises BridgeError: for a password that cannot be read, and for a bus or an address without a name.
    """
    from ..core.sites.settings import SETTINGS_FILE, read_settings
    from ..core.sites.settings_tables import GatewayOptions
    from ..gateway.cluster.cluster import ClusterSettings
    from ..gateway.storage.database import read_password

    if not name:
        for option, value in (("--bus", bus), ("--public-address", public_address)):
            if value:
                raise BridgeError(
                    f"{option} is for gateways with names; give this one a name with --gateway-name, too"
                )
        return None
    given = read_settings(site / SETTINGS_FILE).gateway if site.is_dir() else GatewayOptions()
    password = None if password_file is None else read_password(password_file)
    return ClusterSettings(
        name,
        bus or given.bus or "postgresql",
        password,
        given.when_cut_off == "stop",
        public_address or given.public_address or None,
    )


async def _serve(settings: GatewaySettings, until_stdin_closes: bool) -> None:
    from ..gateway.app import Signals, run

    signals = Signals()
    running = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        running.add_signal_handler(number, _stop, signals)
    running.add_signal_handler(signal.SIGHUP, signals.reload.set)
    if until_stdin_closes:
        call_at_end_of_input(partial(_stop, signals))
    feeding = asyncio.create_task(_feed_watchdog())
    try:
        await run(settings, signals, _started)
    finally:
        feeding.cancel()


def _started(address: str) -> None:
    freeze_permanent_objects()
    # In one piece: lines of standard error may go to the same file.
    print(f"listening on {address}\n", end="")
    notify("READY=1", f"STATUS=listening on {address}")


def _stop(signals: Signals) -> None:
    if not signals.stop.is_set():
        notify("STOPPING=1")
        last = threading.Timer(LAST_MOMENT, _end_at_once)
        last.daemon = True
        last.start()
    signals.stop.set()


def _end_at_once() -> None:
    text = f"robot-bridge: something did not end within {LAST_MOMENT} s; the gateway ends without it"
    print(text, file=sys.stderr)
    finish_writing(LAST_WORDS)
    os._exit(1)


async def _feed_watchdog() -> None:
    interval = watchdog_interval()
    while interval is not None:
        notify("WATCHDOG=1")
        await asyncio.sleep(interval)


def _beside(site: Path, name: str | None) -> Path | None:
    return None if name is None else site / name


def _loop_factory(loop: Loop) -> Callable[[], asyncio.AbstractEventLoop] | None:
    if loop == "asyncio":
        return None
    try:
        import uvloop
    except ImportError:
        if loop == "uvloop":
            raise BridgeError(
                "uvloop is not installed; install it with: pip install 'fleet-supervisor-robot-bridge[speed]'"
            ) from None
        log.info("event loop: asyncio; uvloop, where it is installed, does the same with half the work")
        return None
    log.info("event loop: uvloop")
    factory: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return factory
