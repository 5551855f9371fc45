"""Options of several commands: the database's address, and times."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, date, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from ..core.errors import BridgeError

# --- The options of every command for its database ---

if TYPE_CHECKING:
    from sqlalchemy import URL

    from ..core.sites.settings import SiteSettings
    from ..gateway.site_updates import SiteCopy

DEFAULT = "sqlite:///robot-bridge.db"

DatabaseOption = Annotated[
    str,
    typer.Option(
        "--database",
        envvar="ROBOT_BRIDGE_DATABASE",
        help="sqlite:////PATH, postgresql://ACCOUNT@HOST/NAME or mariadb://ACCOUNT@HOST/NAME.",
    ),
]
PasswordFileOption = Annotated[
    Path | None,
    typer.Option(
        "--database-password-file",
        envvar="ROBOT_BRIDGE_DATABASE_PASSWORD_FILE",
        help="File with the database account's password; a command line can be seen by others.",
    ),
]
BusPasswordFileOption = Annotated[
    Path | None,
    typer.Option(
        "--bus-password-file",
        envvar="ROBOT_BRIDGE_BUS_PASSWORD_FILE",
        help="File with the password of the account in the URL of the bus.",
    ),
]
UntilStdinCloses = Annotated[bool, typer.Option("--until-stdin-closes", hidden=True)]
"""For a parent whose child program must not outlive it, however it ends."""


SiteOption = Annotated[
    str,
    typer.Option(
        help="Folder of a published site: site.toml and site.gpkg; or where it is published in PostGIS: "
        "postgresql://ACCOUNT@HOST/NAME#SITE.",
        envvar="ROBOT_BRIDGE_SITE",
    ),
]


def database_address(database: str, password_file: Path | None) -> URL:
    """Return the address from the two options; raises StoreError."""
    from ..gateway.storage.database import read_address

    return read_address(database, password_file)


# --- A site published in a database instead of a folder ---


def site_copy(site: str, state: Path | None) -> SiteCopy | None:
    """Return the newest available copy of a site in a database; None for a site in a folder.

    :raises BridgeError: if it cannot be fetched and there is no local copy. :raises SiteError: for its
        address.
    """
    from ..core.sites.site_database import is_database_address, read_site_address

    if not is_database_address(site):
        return None
    from ..gateway.site_updates import SiteCopy

    copy = SiteCopy(read_site_address(site), state)
    copy.fetch_first()
    return copy


@contextmanager
def site_folder(site: str) -> Iterator[Path]:
    """Yield the folder of a site; one in a database is fetched temporarily.

    :raises BridgeError: if it cannot be fetched. :raises SiteError: for its address.
    """
    with TemporaryDirectory(prefix="robot-bridge-") as state:
        copy = site_copy(site, Path(state))
        yield Path(site) if copy is None else copy.folder


def site_settings(site: str) -> SiteSettings:
    """Return the settings of a site; raises as :func:`site_folder`, and SiteError if it is no site."""
    from ..core.sites.settings import SETTINGS_FILE, read_settings

    with site_folder(site) as folder:
        return read_settings(folder / SETTINGS_FILE)


# --- Times on the command line ---


def time_span(since: str | None, until: str | None) -> tuple[float | None, float | None]:
    """Return ``--since`` and ``--until`` as seconds since 1970.

    :raises BridgeError: for an invalid time, and for an empty span.
    """
    first, last = seconds_of("--since", since), seconds_of("--until", until)
    if first is not None and last is not None and first > last:
        raise BridgeError(f"--since {since!r} is later than --until {until!r}; nothing lies between them")
    return first, last


def seconds_of(option: str, text: str | None) -> float | None:
    """Return ``text``, the value of ``option``, as seconds since 1970; raises BridgeError."""
    if text is None:
        return None
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        raise BridgeError(f"{option} {text!r} is no time; write it like 2026-11-21T08:00") from None
    return (time if time.tzinfo else time.replace(tzinfo=UTC)).timestamp()


def day_of(option: str, text: str | None) -> int | None:
    """Return ``text``, a day (UTC), as days since 1970-01-01; raises BridgeError."""
    if text is None:
        return None
    try:
        return date.fromisoformat(text).toordinal() - date(1970, 1, 1).toordinal()
    except ValueError:
        raise BridgeError(f"{option} {text!r} is no day; write it like 2026-11-21") from None
