"""Views of the fleet with coordinates in the site's CRS, for GIS programs without the plugin.

On PostgreSQL they are PostGIS geometries, in the site's CRS and in WGS 84, in a schema of their own; on
SQLite they are coordinate columns, from which GDAL's virtual format (VRT) makes points.
"""

from __future__ import annotations

import abc
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple
from xml.sax.saxutils import quoteattr  # nosec B406 # writes XML, reads none

from sqlalchemy import Connection, delete, insert, inspect, select

from ...core.errors import BridgeError
from ...core.json_decoder import SHORT, decode_json
from ...core.sites.frame import SiteFrame, crs_of
from .schema import bridge

SCHEMA = "fleet_map"
"""The schema of the views on PostgreSQL. No account may have this name: it would find them before tables."""
PREFIX = "map_"
"""Prefix of the views' names on SQLite, which has no schemas."""
_FACT = "map_views"
"""Name of the stored fact with the frame of the views, by which an upgrade recreates them."""
WGS84 = 4326


class MapViewError(BridgeError):
    """Views cannot be created on this database or for this site."""


class PlacedRows(NamedTuple):
    """Rows with a position in the site frame, as SQL for all databases.

    In ``source``, ``{newest}`` joins the newest position ``t`` of robot ``r``, by :attr:`MapViews._NEWEST`.
    ``columns`` are expressions by name; those in ``times`` are seconds since 1970. ``x`` and ``y`` are
    metres; ``theta``, where there is any, is counter-clockwise from the site's x axis, in radians.
    """

    source: str
    columns: Mapping[str, str]
    times: Mapping[str, str]
    x: str
    y: str
    theta: str | None = None


_NUMBERS = ("x", "y", "theta", "v", "deviation", "heading", "easting", "northing")


def _of(table: str, *names: str) -> dict[str, str]:
    return {name: f"{table}.{name}" for name in names}


_ROWS = {
    "robots": PlacedRows(
        "{schema}robots r {newest}",
        {"robot": "r.name", "link": "r.link", **_of("t", "x", "y", "theta", "v")},
        {"seen_at": "t.received_at"},
        "t.x",
        "t.y",
        "t.theta",
    ),
    "trajectories": PlacedRows(
        "{schema}trajectories t",
        _of("t", "id", "robot", "x", "y", "theta", "v"),
        {"at": "t.received_at"},
        "t.x",
        "t.y",
        "t.theta",
    ),
    "cones": PlacedRows(
        "{schema}placements p",
        _of("p", "id", "robot", "cone", "label", "layout", "plan", "x", "y", "theta", "deviation"),
        {"placed_at": "p.placed_at", "collected_at": "p.collected_at"},
        "p.x",
        "p.y",
        "p.theta",
    ),
    "observations": PlacedRows(
        "{schema}observations o",
        _of("o", "id", "robot", "kind", "object", "state", "x", "y"),
        {"seen_at": "o.seen_at", "received_at": "o.received_at"},
        "o.x",
        "o.y",
    ),
    "commands": PlacedRows(
        "{schema}commands c",
        _of("c", "id", "robot", "op", "operator", "state", "deviation"),
        {"created_at": "c.created_at", "expires_at": "c.expires_at"},
        "{x_of_params}",
        "{y_of_params}",
    ),
}


# --- PostGIS and SQLite ---


class MapViews(abc.ABC):
    """The views of one database, over a connection of the owner of its tables."""

    _PARAMS: Mapping[str, str]
    """SQL for the goal of a command, by axis."""
    _SCHEMA: str = ""
    """Prefix of table names."""
    _NEWEST: str
    """SQL that joins the newest position of a robot."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def make(self, frame: SiteFrame) -> list[str]:
        """Create the views of a site with ``frame``, replacing existing ones; return their names.

        :raises MapViewError: on MariaDB, without PostGIS, and for a CRS without an EPSG code.
        """
        srid = _epsg_code(frame)
        self.remove()
        names = self._make(frame, srid)
        kept = {"crs": frame.crs, "origin": list(frame.origin), "rotation": frame.rotation}
        self._connection.execute(insert(bridge).values(name=_FACT, value=json.dumps(kept)))
        return names

    def frame(self) -> SiteFrame | None:
        """Return the frame of the existing views, or None."""
        kept = self._connection.scalar(select(bridge.c.value).where(bridge.c.name == _FACT))
        if kept is None:
            return None
        found = decode_json(kept, SHORT)
        return SiteFrame(found["crs"], (found["origin"][0], found["origin"][1]), found["rotation"])

    @abc.abstractmethod
    def remove(self) -> None:
        """Remove the views, if there are any."""

    @abc.abstractmethod
    def _make(self, frame: SiteFrame, srid: int) -> list[str]: ...

    def _source(self, rows: PlacedRows) -> str:
        """Return the FROM clause of the rows."""
        return rows.source.format(schema=self._SCHEMA, newest=self._NEWEST)

    def _axes(self, rows: PlacedRows) -> tuple[str, str]:
        """Return the expressions of x and y in the site frame."""
        params = {f"{axis}_of_params": expression for axis, expression in self._PARAMS.items()}
        return rows.x.format(**params), rows.y.format(**params)

    def _forget(self) -> None:
        self._connection.execute(delete(bridge).where(bridge.c.name == _FACT))

    def _do(self, statement: str) -> None:
        # Without parameters the drivers do not interpret percent signs.
        self._connection.exec_driver_sql(statement, execution_options={"no_parameters": True})


_POSTGIS_PARAMS = {
    axis: f"coalesce((c.params::jsonb ->> '{axis}')::float8, "
    f"(c.params::jsonb -> 'points' -> -1 ->> {place})::float8)"
    for place, axis in enumerate("xy")
}
_PATHS = """
    create view {schema}.paths as
    select c.id, c.robot, c.operator, c.state, to_timestamp(c.created_at) as created_at,
           line.geom::{gis}.geometry(LineString, {srid}) as geom,
           {gis}.st_transform(line.geom, {wgs84})::{gis}.geometry(LineString, {wgs84}) as geom_4326
    from public.commands c cross join lateral (
        select {gis}.st_setsrid({gis}.st_makeline(
            {gis}.st_makepoint({east}, {north}) order by place.number), {srid}) as geom
        from (
            select (p.xy ->> 0)::float8 as x, (p.xy ->> 1)::float8 as y, p.number
            from jsonb_array_elements(c.params::jsonb -> 'points') with ordinality as p (xy, number)
        ) as place
    ) as line
    where c.op = 'SetPath'"""


class PostGisViews(MapViews):
    """Views in the schema ``fleet_map``; accounts that may use that schema may read all of them."""

    _PARAMS = _POSTGIS_PARAMS
    _SCHEMA = "public."
    # Uses the index of each partition on robot and time; there is none on ids.
    _NEWEST = (
        "cross join lateral (select * from public.trajectories n where n.robot = r.name "
        "order by n.received_at desc, n.id desc limit 1) t"
    )

    def remove(self) -> None:
        for name in (*_ROWS, "paths"):
            self._do(f"drop view if exists {SCHEMA}.{name}")
        self._forget()

    def require(self) -> None:
        """Raise MapViewError if there are no views."""
        if self.frame() is None:
            raise MapViewError(
                "there are no views yet for an account to read; make them with: "
                "robot-bridge database views --site SITE"
            )

    def readers(self) -> list[str]:
        """Return the accounts, other than the owner, that may read the views."""
        found = self._connection.exec_driver_sql(
            "select a.grantee::regrole::text from pg_namespace n, aclexplode(n.nspacl) a "  # nosec B608 # names of ours
            f"where n.nspname = '{SCHEMA}' and a.privilege_type = 'USAGE' "
            "and a.grantee not in (0, n.nspowner)"
        )
        return sorted(set(found.scalars()))

    def let_read(self, role: str) -> None:
        """Grant the account ``role`` (quoted if needed) the views and PostGIS."""
        self._do(f"grant usage on schema {SCHEMA}, {self._gis()} to {role}")
        self._do(f"grant select on all tables in schema {SCHEMA} to {role}")

    def _make(self, frame: SiteFrame, srid: int) -> list[str]:
        gis = self._gis()
        if self._connection.exec_driver_sql(f"select 1 from pg_roles where rolname = '{SCHEMA}'").scalar():  # nosec B608 # names of ours
            raise MapViewError(
                f"the server has an account {SCHEMA!r}, for which the views would stand in the place of the "
                "tables; rename that account"
            )
        self._do(f"create schema if not exists {SCHEMA}")
        for name, rows in _ROWS.items():
            self._do(f"create view {SCHEMA}.{name} as {self._select(rows, frame, gis, srid)}")
        east, north = _in_crs("place.x", "place.y", frame)
        self._do(_PATHS.format(schema=SCHEMA, gis=gis, srid=srid, wgs84=WGS84, east=east, north=north))
        for reader in self.readers():
            self.let_read(reader)
        return [f"{SCHEMA}.{name}" for name in (*_ROWS, "paths")]

    def _select(self, rows: PlacedRows, frame: SiteFrame, gis: str, srid: int) -> str:
        east, north = _in_crs(*self._axes(rows), frame)
        place = f"{gis}.st_setsrid({gis}.st_makepoint({east}, {north}), {srid})"
        columns = {
            **rows.columns,
            **{name: f"to_timestamp({at})" for name, at in rows.times.items()},
            **_heading(rows, frame),
            "geom": f"{place}::{gis}.geometry(Point, {srid})",
            "geom_4326": f"{gis}.st_transform({place}, {WGS84})::{gis}.geometry(Point, {WGS84})",
        }
        return f"select {_listed(columns)} from {self._source(rows)}"  # nosec B608 # names of ours

    def _gis(self) -> str:
        """Return the schema of PostGIS, quoted if needed."""
        found = self._connection.exec_driver_sql(
            "select extnamespace::regnamespace::text from pg_extension where extname = 'postgis'"
        ).scalar()
        if found is None:
            raise MapViewError(
                "views with geometries need PostGIS, which this database does not have; install the package "
                "postgresql-15-postgis-3 (of your version) on the server, and as its administrator run in "
                "this database: create extension postgis"
            )
        return str(found)


_SQLITE_PARAMS = {
    axis: f"coalesce(json_extract(c.params, '$.{axis}'), json_extract(c.params, '$.points[#-1][{place}]'))"
    for place, axis in enumerate("xy")
}


class SQLiteViews(MapViews):
    """Views with the columns ``easting`` and ``northing``; :func:`virtual_layers` makes points of them."""

    _PARAMS = _SQLITE_PARAMS
    _NEWEST = (
        "join trajectories t on t.id = (select max(n.id) from trajectories n where n.robot = r.name and "
        "n.received_at = (select max(m.received_at) from trajectories m where m.robot = r.name))"
    )

    def remove(self) -> None:
        for name in _ROWS:
            self._do(f"drop view if exists {PREFIX}{name}")
        self._forget()

    def _make(self, frame: SiteFrame, srid: int) -> list[str]:
        for name, rows in _ROWS.items():
            east, north = _in_crs(*self._axes(rows), frame)
            columns = {
                **rows.columns,
                **{at: _utc(seconds) for at, seconds in rows.times.items()},
                **_heading(rows, frame),
                "easting": east,
                "northing": north,
            }
            source = self._source(rows)
            self._do(f"create view {PREFIX}{name} as select {_listed(columns)} from {source}")  # nosec B608 # names of ours
        return [f"{PREFIX}{name}" for name in _ROWS]


_KINDS: dict[str, type[MapViews]] = {"postgresql": PostGisViews, "sqlite": SQLiteViews}


def map_views_on(connection: Connection) -> MapViews:
    """Return the views of the database behind ``connection``; raises MapViewError for MariaDB."""
    kind = _KINDS.get(connection.dialect.name)
    if kind is None:
        raise MapViewError(
            "MariaDB has no views for GIS programs: its geometries do not know a CRS in metres. Use "
            "PostgreSQL with PostGIS, or SQLite"
        )
    return kind(connection)


@contextmanager
def views_made_again(connection: Connection) -> Iterator[None]:
    """Remove the views while the block changes their tables, then create them again."""
    known = connection.dialect.name in _KINDS and inspect(connection).has_table(bridge.name)
    views = map_views_on(connection) if known else None
    frame = None if views is None else views.frame()
    if views is None or frame is None:
        yield
        return
    views.remove()
    yield
    views.make(frame)


def virtual_layers(database: str, frame: SiteFrame) -> str:
    """Return a VRT file that shows GDAL and QGIS the views of the SQLite file ``database`` as points."""
    srid = _epsg_code(frame)
    layers = "".join(
        f'  <OGRVRTLayer name="{name}">\n'
        f"    <SrcDataSource>{quoteattr(database)[1:-1]}</SrcDataSource>\n"
        # Rows without a position would appear at (0, 0).
        f"    <SrcSQL>select * from {PREFIX}{name} where easting is not null</SrcSQL>\n"
        "    <GeometryType>wkbPoint</GeometryType>\n"  # nosec B608 # a name of ours
        f"    <LayerSRS>EPSG:{srid}</LayerSRS>\n"
        '    <GeometryField encoding="PointFromColumns" x="easting" y="northing"/>\n'
        f"{_virtual_fields(rows, frame)}"
        "  </OGRVRTLayer>\n"
        for name, rows in _ROWS.items()
    )
    return f"<OGRVRTDataSource>\n{layers}</OGRVRTDataSource>\n"


def _virtual_fields(rows: PlacedRows, frame: SiteFrame) -> str:
    """Return the fields of a layer with their types: SQLite has no type for times, which it keeps as text."""
    names = [*rows.columns, *rows.times, *_heading(rows, frame), "easting", "northing"]
    kinds = dict.fromkeys(rows.times, "DateTime") | dict.fromkeys(_NUMBERS, "Real") | {"id": "Integer64"}
    return "".join(
        f'    <Field name="{name}" src="{name}" type="{kinds.get(name, "String")}"/>\n' for name in names
    )


def _epsg_code(frame: SiteFrame) -> int:
    authority = crs_of(frame.crs).to_authority(min_confidence=100)
    if authority is None or authority[0] != "EPSG":
        raise MapViewError(
            f"the site's CRS {frame.crs!r} has no EPSG code, by which databases name a CRS; publish the site "
            "in one that has"
        )
    return int(authority[1])


def _in_crs(x: str, y: str, frame: SiteFrame) -> tuple[str, str]:
    """Return the expressions of easting and northing of the site's ``x`` and ``y``."""
    (east_x, north_x), (east_y, north_y) = frame.axes().tolist()
    east, north = frame.origin
    return (
        f"({east!r} + ({x}) * ({east_x!r}) + ({y}) * ({east_y!r}))",
        f"({north!r} + ({x}) * ({north_x!r}) + ({y}) * ({north_y!r}))",
    )


def _heading(rows: PlacedRows, frame: SiteFrame) -> dict[str, str]:
    """Return the column of degrees clockwise from the CRS's north, in [0, 360), where there is a heading."""
    if rows.theta is None:
        return {}
    # Both angles are within half a turn, so that adding one turn is enough.
    rotation = math.remainder(frame.rotation, math.tau)
    degrees = f"(90.0 - (({rows.theta}) + ({rotation!r})) * {180 / math.pi!r})"
    cases = f"when {degrees} < 0 then {degrees} + 360 when {degrees} >= 360 then {degrees} - 360"
    return {"heading": f"case {cases} else {degrees} end"}


def _utc(seconds: str) -> str:
    return f"strftime('%Y-%m-%dT%H:%M:%fZ', {seconds}, 'unixepoch')"


def _listed(columns: Mapping[str, str]) -> str:
    return ", ".join(f"{expression} as {name}" for name, expression in columns.items())
