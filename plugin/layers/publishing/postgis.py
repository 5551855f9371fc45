"""Publication of a site into PostgreSQL with PostGIS: complete versions, switched by a commit.

The content is that of the publication's folder: its layers as tables for GIS programs, and its
files for gateways. The tables are described in ``robot_bridge.core.sites.site_database``.
"""

from __future__ import annotations

import hashlib
import sqlite3
import struct
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsDataSourceUri,
    QgsFeedback,
    QgsProviderConnectionException,
    QgsProviderRegistry,
)

from ....robot_bridge.core.errors import in_one_line
from ....robot_bridge.core.sites.geopackage import GEOPACKAGE_FILE, LayerSpec
from ....robot_bridge.core.sites.settings import SETTINGS_FILE, SiteSettings
from ....robot_bridge.core.sites.site_database import (
    FORMAT,
    LONGEST_ID,
    PART_BYTES,
    SCHEMA,
    SITE_FILES,
    TABLES,
    digest_text,
    is_database_address,
    version_schema,
    view_schema,
)
from ...ui.errors import PublicationError
from ...ui.language import tr
from .site_content import LAYERS

# --- The database for a site: a connection of QGIS's, or an address ---

CONNECT_WITHIN_S = 10
LOCKED_FOR_S = 10
_CONNECT = {
    "connect_timeout": CONNECT_WITHIN_S,
    "application_name": "Fleet Supervisor",
    "client_encoding": "utf8",
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
}
_INSTALL = tr("install the distribution's package, such as python3-psycopg2.")


def database_address(name: str) -> str:
    """Return the libpq connection string for ``name``: a PostgreSQL connection of QGIS's, or such a string.

    Must be called in the main thread, as QGIS may ask for its master password. It does not connect.

    :raises PublicationError: when QGIS has no such connection.
    """
    if is_database_address(name) or "=" in name:
        return name
    try:
        connection = QgsProviderRegistry.instance().providerMetadata("postgres").findConnection(name, False)
    except QgsProviderConnectionException:
        connection = None
    if connection is None:
        raise PublicationError(
            tr(
                "QGIS has no PostgreSQL connection {name}; it has: {known}. Make it in the browser panel, "
                "PostgreSQL > New Connection, or write the address of the database, such as "
                "postgresql://account@host/database.",
                name=name,
                known=", ".join(sorted(_connections())) or tr("none"),
            )
        )
    return str(QgsDataSourceUri(connection.uri()).connectionInfo(True))


def _connections() -> Sequence[str]:
    return list(QgsProviderRegistry.instance().providerMetadata("postgres").connections(False))


def check_site_id(site: str) -> None:
    """Raise :class:`PublicationError` where ``site`` is too long for the name of a schema."""
    if len(site.encode()) > LONGEST_ID:
        raise PublicationError(
            tr(
                "SITE_ID {site} is too long for a database: give one of at most {most} letters.",
                site=site,
                most=LONGEST_ID,
            )
        )


# --- The publication itself ---


@contextmanager
def site_database(address: str, site: str) -> Iterator[SiteDatabase]:
    """Connect to the database at ``address`` and check that ``site`` may be published there.

    Any failure in the block leaves the database as it was, and is raised with its remedy.

    :raises PublicationError: when it cannot be reached, has no PostGIS, contains other data or refuses.
    """
    psycopg2 = _psycopg2()
    try:
        connection = psycopg2.connect(address, **_CONNECT)
    except psycopg2.Error as error:
        raise PublicationError(
            tr(
                "The database cannot be reached: {error}. Check that it runs, and the host, database, "
                "account and password of the connection.",
                error=in_one_line(error).rstrip("."),
            )
        ) from error
    with closing(connection):
        try:
            with connection.cursor() as cursor:
                cursor.execute(f"set lock_timeout = '{LOCKED_FOR_S}s'")
                yield SiteDatabase(cursor, site)
        except psycopg2.Error as error:
            raise _refused(connection, site, error, psycopg2) from error


class SiteDatabase:
    """One site in one database, over ``cursor``; the published version is read on construction."""

    def __init__(self, cursor: Any, site: str) -> None:
        self._cursor, self._site = cursor, site
        self._gis = self._postgis()
        self._has_tables = self._check_tables()
        self.version = self._version()
        """The published version, 0 where there is none."""
        self.settings_text = self._settings_text()
        """The published ``site.toml``; empty where there is none."""
        cursor.connection.commit()

    @contextmanager
    def new_version(self, settings: SiteSettings, folder: Path, feedback: QgsFeedback) -> Iterator[bool]:
        """Write the publication in ``folder``, which takes effect when the block ends.

        Yields false, and changes nothing, if cancelled. When the block ends by an exception all is as it was.

        :raises PublicationError: when another version was published since this was constructed, or the CRS is
        not known there.
        """
        connection = self._cursor.connection
        try:
            whole = self._write(settings, folder, feedback)
            yield whole
            if whole:
                self._commit()
        finally:
            if not connection.closed:
                connection.rollback()

    def remove_earlier(self, settings: SiteSettings) -> list[str]:
        """Remove the tables of earlier versions; return the schemas that are still in use."""
        psycopg2, connection, kept = _psycopg2(), self._cursor.connection, []
        prefix = version_schema(self._site, 0)[:-1]
        self._cursor.execute(
            "select nspname from pg_namespace where starts_with(nspname, %s) and nspname <> %s",
            [prefix, version_schema(self._site, settings.version)],
        )
        for (schema,) in self._cursor.fetchall():
            try:
                tables = ", ".join(f"{_quoted(schema)}.{_quoted(spec.name)}" for spec in LAYERS)
                self._cursor.execute(f"drop table if exists {tables}; drop schema {_quoted(schema)}")
                connection.commit()
            except psycopg2.Error:
                connection.rollback()
                kept.append(schema)
        return kept

    def _commit(self) -> None:
        try:
            self._cursor.connection.commit()
        except _psycopg2().Error as error:
            raise PublicationError(
                tr(
                    "The connection to database {database} was lost at the last moment: {site} is published "
                    "there, or is as it was. Publish again.",
                    database=self._database,
                    site=self._site,
                )
            ) from error

    # --- Reading ---

    def _postgis(self) -> str:
        found = self._one(
            "select extnamespace::regnamespace::text from pg_extension where extname = 'postgis'"
        )
        if found is None:
            raise PublicationError(
                tr(
                    "The database {database} has no PostGIS. Install the package postgresql-15-postgis-3 (of "
                    "your version) on the server, and as its administrator run in this database: create "
                    "extension postgis",
                    database=self._database,
                )
            )
        return str(found)

    def _check_tables(self) -> bool:
        comment = "select coalesce(obj_description(oid, 'pg_namespace'), '') from pg_namespace"
        found = self._one(f"{comment} where nspname = %s", SCHEMA)
        if found not in (None, FORMAT):
            raise PublicationError(
                tr(
                    "The schema {schema} of database {database} is of another program, or of another version "
                    "of this one (it says “{found}”): publish with that, or into another database.",
                    schema=SCHEMA,
                    database=self._database,
                    found=found,
                )
            )
        self._check_rights(is_new=found is None)
        return found is not None

    def _check_rights(self, is_new: bool) -> None:
        account = self._one("select current_user")
        if not self._one("select has_database_privilege(current_database(), 'CREATE')"):
            raise PublicationError(
                tr(
                    "The account {account} may make no schemas in database {database}, and a site is "
                    "published in some. Its owner runs: {command}",
                    account=account,
                    database=self._database,
                    command=f"grant create on database {_quoted(self._database)} to {_quoted(account)}",
                )
            )
        owner = None if is_new else self._owner()
        if owner is not None and not self._one("select pg_has_role(%s::name, 'USAGE')", owner):
            raise PublicationError(
                tr(
                    "The sites in database {database} belong to the account {owner}, and not to {account}: "
                    "publish as {owner}, or have an administrator run: {command}",
                    database=self._database,
                    owner=owner,
                    account=account,
                    command=f"grant {_quoted(owner)} to {_quoted(account)}",
                )
            )

    def _owner(self) -> str:
        return str(self._one("select pg_get_userbyid(nspowner) from pg_namespace where nspname = %s", SCHEMA))

    def _version(self) -> int:
        if not self._has_tables:
            return 0
        return int(self._one(f"select version from {SCHEMA}.sites where site = %s", self._site) or 0)  # nosec B608 # names of ours

    def _settings_text(self) -> str:
        if not self.version:
            return ""
        content = self._one(
            f"select string_agg(content, null::bytea order by number) from {SCHEMA}.parts "  # nosec B608 # names of ours
            "where site = %s and version = %s and name = %s",
            self._site,
            self.version,
            SETTINGS_FILE,
        )
        return bytes(content or b"").decode("utf-8", "replace")

    @property
    def _database(self) -> str:
        return str(self._cursor.connection.info.dbname)

    def _one(self, query: str, *values: object) -> Any:
        self._cursor.execute(query, values)
        row = self._cursor.fetchone()
        return None if row is None else row[0]

    # --- Writing ---

    def _write(self, settings: SiteSettings, folder: Path, feedback: QgsFeedback) -> bool:
        """Write and switch, without a commit; return false if cancelled."""
        if not self._has_tables:
            self._cursor.execute(TABLES)
        self._switch(settings, folder)
        schema, srid = version_schema(self._site, settings.version), self._srid(settings.crs)
        self._cursor.execute(f"create schema {_quoted(schema)}")
        with closing(sqlite3.connect(f"{(folder / GEOPACKAGE_FILE).as_uri()}?mode=ro", uri=True)) as source:
            for spec in LAYERS:
                if feedback.isCanceled() or not self._copy_layer(source, spec, schema, srid, feedback):
                    return False
        for name in _files(folder):
            for number, part in enumerate(_parts(folder / name)):
                if feedback.isCanceled():
                    return False
                self._cursor.execute(
                    f"insert into {SCHEMA}.parts values (%s, %s, %s, %s, %s)",  # nosec B608 # names of ours
                    [self._site, settings.version, name, number, part],
                )
        # Last: from here on nobody can read the views until the commit.
        self._renew_views(schema)
        return True

    def _switch(self, settings: SiteSettings, folder: Path) -> None:
        """Set the new version in the registry; other publications of the site wait for the commit."""
        digests = {name: _digest(folder / name) for name in _files(folder)}
        digest = hashlib.sha256(digest_text(digests)).hexdigest()
        row = (settings.version, digest, self._site)
        self._cursor.execute(
            f"update {SCHEMA}.sites set version = %s, digest = %s, published_at = now(), "  # nosec B608 # names of ours
            "published_by = current_user where site = %s and version = %s"
            if self.version
            else f"insert into {SCHEMA}.sites (version, digest, site) values (%s, %s, %s) "  # nosec B608 # names of ours
            "on conflict do nothing",
            (*row, self.version) if self.version else row,
        )
        if self._cursor.rowcount != 1:
            raise PublicationError(
                tr(
                    "Another publication of {site} into database {database} has ended meanwhile: publish "
                    "again.",
                    site=self._site,
                    database=self._database,
                )
            )
        for table in ("parts", "files"):
            self._cursor.execute(f"delete from {SCHEMA}.{table} where site = %s", [self._site])  # nosec B608 # names of ours
        for name, of_file in digests.items():
            size = (folder / name).stat().st_size
            self._cursor.execute(
                f"insert into {SCHEMA}.files values (%s, %s, %s, %s, %s)",  # nosec B608 # names of ours
                [self._site, settings.version, name, size, of_file],
            )

    def _srid(self, crs: str) -> int:
        authority, _, code = crs.partition(":")
        query = f"select srid from {self._gis}.spatial_ref_sys where auth_name = %s and auth_srid = %s"  # nosec B608 # names of ours
        found = self._one(query, authority, int(code)) if code.isdecimal() else None
        if found is None:
            raise PublicationError(
                tr(
                    "The PostGIS of database {database} does not know {crs}: choose a SITE_CRS that its "
                    "table spatial_ref_sys has, or have an administrator add this one there.",
                    database=self._database,
                    crs=crs,
                )
            )
        return int(found)

    def _copy_layer(
        self, source: sqlite3.Connection, spec: LayerSpec, schema: str, srid: int, feedback: QgsFeedback
    ) -> bool:
        table = f"{_quoted(schema)}.{_quoted(spec.name)}"
        kind = f"{self._gis}.geometry({_GEOMETRY_KINDS[spec.geometry]}, {srid})"
        fields = "".join(f", {_quoted(name)} {_TYPES[type_]}" for name, type_ in spec.fields.items())
        self._cursor.execute(f"create table {table} (id bigint primary key, geom {kind}{fields})")
        names = ", ".join(_quoted(name) for name in spec.fields)
        rows = source.execute(f"select fid, geom, {names} from {_quoted(spec.name)}")  # nosec B608 # names of ours
        stream = _CopyStream(rows, srid, feedback)
        self._cursor.copy_expert(f"copy {table} (id, geom, {names}) from stdin", stream)
        self._cursor.execute(f"create index on {table} using gist (geom)")
        self._cursor.execute(f"analyze {table}")
        return not stream.is_cut

    def _renew_views(self, schema: str) -> None:
        """Point the views of the site to the tables in ``schema``; privileges to read them are kept."""
        views = _quoted(view_schema(self._site))
        self._cursor.execute(f"create schema if not exists {views}")
        for spec in LAYERS:
            view = f"{views}.{_quoted(spec.name)}"
            made = f"view {view} as select * from {_quoted(schema)}.{_quoted(spec.name)}"  # nosec B608 # names of ours
            self._cursor.execute("savepoint before_view")
            try:
                self._cursor.execute(f"create or replace {made}")
            except _psycopg2().errors.InvalidTableDefinition:
                # Its columns have changed: another CRS, another version of this program.
                self._cursor.execute("rollback to savepoint before_view")
                readers = self._readers(view)
                self._cursor.execute(f"drop view {view}")
                self._cursor.execute(f"create {made}")
                for reader in readers:
                    self._cursor.execute(f"grant select on {view} to {reader}")

    def _readers(self, view: str) -> list[str]:
        self._cursor.execute(
            "select distinct case when a.grantee = 0 then 'public' else a.grantee::regrole::text end "
            "from pg_class c, aclexplode(c.relacl) a "
            "where c.oid = to_regclass(%s) and a.privilege_type = 'SELECT' and a.grantee <> c.relowner",
            [view],
        )
        return [reader for (reader,) in self._cursor.fetchall()]


_GEOMETRY_KINDS = {"Unknown": "Geometry", "LineString": "LineString", "Polygon": "Polygon"}
_TYPES = {str: "text", float: "float8", bool: "boolean", int: "bigint"}


# --- The rows of a layer of site.gpkg, and its files, in the form that the database takes ---

_ROWS_AT_ONCE = 500
_BOX_BYTES = (0, 32, 48, 48, 64)
"""Bytes of the box in the header of a GeoPackage geometry, by its kind (OGC 12-128r18, 2.1.3)."""
_WITH_SRID = 0x20000000
_ESCAPES = str.maketrans({"\\": "\\\\", "\t": "\\t", "\n": "\\n", "\r": "\\r"})


class _CopyStream:
    """Input of COPY: ``rows`` of id, geometry and fields, until ``feedback`` is cancelled."""

    def __init__(self, rows: sqlite3.Cursor, srid: int, feedback: QgsFeedback) -> None:
        self._rows, self._srid, self._feedback = rows, srid, feedback
        self._rest = b""
        self.is_cut = False

    def read(self, size: int) -> bytes:
        """Return at most ``size`` bytes, none at the end."""
        if not self._rest:
            self.is_cut = self._feedback.isCanceled()
            some = [] if self.is_cut else self._rows.fetchmany(_ROWS_AT_ONCE)
            self._rest = "".join(self._line(*row) for row in some).encode()
        part, self._rest = self._rest[:size], self._rest[size:]
        return part

    def _line(self, id: int, geometry: bytes, *values: object) -> str:
        return "\t".join([str(id), _extended(geometry, self._srid), *map(_field, values)]) + "\n"


def _field(value: object) -> str:
    return "\\N" if value is None else str(value).translate(_ESCAPES)


def _extended(blob: bytes, srid: int) -> str:
    """Return a geometry of a GeoPackage in PostGIS's format: hexadecimal, with its CRS."""
    start = 8 + _BOX_BYTES[blob[3] >> 1 & 7]
    order = "<" if blob[start] else ">"
    (kind,) = struct.unpack_from(f"{order}I", blob, start + 1)
    head = struct.pack(f"{order}BII", blob[start], kind | _WITH_SRID, srid)
    return (head + blob[start + 5 :]).hex()


def _files(folder: Path) -> list[str]:
    return [name for name in SITE_FILES if (folder / name).is_file()]


def _parts(file: Path) -> Iterator[bytes]:
    with file.open("rb") as stream:
        while part := stream.read(PART_BYTES):
            yield part


def _digest(file: Path) -> str:
    digest = hashlib.sha256()
    for part in _parts(file):
        digest.update(part)
    return digest.hexdigest()


# --- PostgreSQL's errors as text with a remedy ---


def _refused(connection: Any, site: str, error: Exception, psycopg2: Any) -> PublicationError:
    database = connection.info.dbname
    if isinstance(error, psycopg2.errors.LockNotAvailable):
        text = tr(
            "Somebody has read or written {site} in database {database} for more than {seconds} s: wait "
            "until another publication has ended, close what shows its layers, and publish again.",
            site=site,
            database=database,
            seconds=LOCKED_FOR_S,
        )
    elif isinstance(error, psycopg2.errors.DependentObjectsStillExist):
        text = tr(
            "Something of yours is made of the views of {site} in database {database}, which stand for one "
            "version: {error}. Remove it, publish, and make it again.",
            site=site,
            database=database,
            error=in_one_line(error).rstrip("."),
        )
    else:
        text = tr(
            "The site cannot be published in database {database}: {error}. What was published there before "
            "is as it was.",
            database=database,
            error=in_one_line(error).rstrip("."),
        )
    return PublicationError(text)


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


def _psycopg2() -> Any:
    try:
        import psycopg2
        import psycopg2.errors
    except ImportError as error:
        raise PublicationError(
            tr(
                "The Python package psycopg2 is missing in this QGIS, which writes to PostgreSQL: {install}",
                install=_INSTALL,
            )
        ) from error
    return psycopg2
