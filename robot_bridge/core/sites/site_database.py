"""Sites published in PostgreSQL with PostGIS: their address, and the tables that publisher and gateway share.

The schema ``fleet_sites`` holds the newest version of each site: one row in ``sites``, which is switched in
the transaction that writes everything else, and in ``files`` and ``parts`` the files of its folder, which a
gateway fetches. The layers of a version are tables in a schema of that version, and views in a schema of the
site show those of the newest, for GIS programs.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote, urlsplit, urlunsplit

from ..errors import SiteError
from .geopackage import GEOPACKAGE_FILE
from .settings import SETTINGS_FILE
from .site_cache import CACHE_FILE

SCHEMA = "fleet_sites"
FORMAT = "sites of Fleet Supervisor, format 1"
"""The comment of the schema, which identifies its format."""
SITE_FILES = (CACHE_FILE, GEOPACKAGE_FILE, SETTINGS_FILE)
"""The files of a site's folder; all but the first are mandatory."""
PART_BYTES = 4 << 20
"""Bytes of a file per row: neither side holds more of it at a time."""
LONGEST_ID = 40
"""Bytes of a site's id, which are part of the names of schemas."""

TABLES = f"""\
create schema {SCHEMA};
comment on schema {SCHEMA} is '{FORMAT}';
create table {SCHEMA}.sites (
    site text primary key,
    version bigint not null,
    digest text not null,
    published_at timestamptz not null default now(),
    published_by text not null default current_user
);
create table {SCHEMA}.files (
    site text, version bigint, name text, size bigint not null, digest text not null,
    primary key (site, version, name)
);
create table {SCHEMA}.parts (
    site text, version bigint, name text, number integer, content bytea not null,
    primary key (site, version, name, number)
);
alter table {SCHEMA}.parts alter content set storage external"""
"""``digest`` of a file is its SHA-256, that of a site the SHA-256 of :func:`digest_text`."""

SCHEMES = ("postgresql", "postgres")


def view_schema(site: str) -> str:
    """Return the schema in which GIS programs find the newest version of ``site``."""
    return f"site_{site}"


def version_schema(site: str, version: int) -> str:
    """Return the schema of the tables of one version; no id of a site contains the separator."""
    return f"{view_schema(site)}@{version}"


def digest_text(files: dict[str, str]) -> bytes:
    """Return the input for the digest of a version: the names and digests of its ``files``."""
    return "".join(f"{digest}  {name}\n" for name, digest in sorted(files.items())).encode()


class SiteAddress(NamedTuple):
    """Where a site is published: the database's ``conninfo``, as libpq reads it, and the site's id."""

    conninfo: str
    site: str

    @property
    def shown(self) -> str:
        """The address without its password."""
        parts = urlsplit(self.conninfo)
        account, _, host = parts.netloc.rpartition("@")
        name = account.partition(":")[0]
        netloc = f"{name}@{host}" if account else host
        return f"{urlunsplit((parts.scheme, netloc, parts.path, '', ''))}#{self.site}"


def is_database_address(text: str) -> bool:
    """Return whether ``text`` is the address of a PostgreSQL database, not a folder."""
    return text.partition("://")[0] in SCHEMES and "://" in text


def read_site_address(text: str) -> SiteAddress:
    """Return the parts of ``postgresql://account@host/database#site``.

    :raises SiteError: if the site is missing, or its id is invalid.
    """
    parts = urlsplit(text)
    site = unquote(parts.fragment)
    address = SiteAddress(urlunsplit(parts._replace(fragment="")), site)
    if not site or Path(site).name != site or site.startswith("."):
        raise SiteError(
            f"--site {address.shown} names no site: write it like "
            "postgresql://account@host/database#site, with the site's id behind the #"
        )
    return address
