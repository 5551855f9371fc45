"""``fleet:publishsite`` into PostGIS: whole versions, what GIS programs see of them, and every refusal."""

from __future__ import annotations

import hashlib
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import psycopg
import pytest
from fleet_supervisor.plugin.layers.publishing import postgis as postgis_publication
from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup
from fleet_supervisor.plugin.ui.errors import PublicationError
from fleet_supervisor.robot_bridge.core.sites.settings import SETTINGS_FILE, read_settings
from fleet_supervisor.robot_bridge.core.sites.site import read_site
from fleet_supervisor.robot_bridge.core.sites.site_database import FORMAT, SITE_FILES, read_site_address
from fleet_supervisor.robot_bridge.gateway.site_updates import SiteCopy
from osgeo import ogr
from qgis.core import (
    QgsDataSourceUri,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsProviderRegistry,
    QgsVectorLayer,
)
from sqlalchemy import make_url

LAYERS = ("obstacles", "road_centrelines", "road_surfaces", "keepouts")
RING = "Polygon((0 0, 20 0, 20 10, 0 10, 0 0), (5 3, 9 3, 9 7, 5 7, 5 3))"


@pytest.fixture(scope="module")
def sample(root) -> Path:
    return root / "resources" / "sample_site" / "sample_site.qgz"


@pytest.fixture(scope="module")
def postgis(postgis_server):
    """The URL of a database with PostGIS, of the account that owns it."""
    url = postgis_server.new_database()
    postgis_server.sql("create extension postgis", make_url(url).database)
    return url


@pytest.fixture
def database(postgis):
    """The same with nothing in it."""
    yield postgis
    run(postgis, *(f'drop schema if exists "{name}" cascade' for name in {*schemas(postgis), "fleet_sites"}))


@pytest.fixture
def publish(provider, listener, make_layer):
    """Publish a house, by ``processing.run``."""
    import processing

    def run(feedback=None, project=None, **parameters) -> dict:
        context = QgsProcessingContext()
        context.setProject(project or QgsProject())
        house = make_layer("house", "Polygon", features=[(RING, 9.5)])
        everything = {"OBSTACLES": [house], "SITE_ID": "yard", "SITE_CRS": "EPSG:32633", **parameters}
        return processing.run(
            "fleet:publishsite",
            everything,
            context=context,
            feedback=feedback or listener,
            is_child_algorithm=True,
        )

    return run


def run(url, *statements):
    with closing(psycopg.connect(url, autocommit=True)) as connection:
        for statement in statements:
            connection.execute(statement)


def rows(url, query, *values):
    with closing(psycopg.connect(url, autocommit=True)) as connection:
        return connection.execute(query, values).fetchall()


def files_in(url, site) -> dict[str, bytes]:
    """The files of the version in force, put together of their parts."""
    query = (
        "select name, string_agg(content, ''::bytea order by number) from fleet_sites.parts where site = %s"
    )
    return dict(rows(url, f"{query} group by name", site))


def schemas(url) -> set[str]:
    return {name for (name,) in rows(url, "select nspname from pg_namespace where nspname ~ '^site_'")}


def shapes(layer) -> list:
    """Geometry and fields of each feature, but for its number and for columns of GDAL's own."""
    found = []
    for feature in layer:
        values = {name: value for name, value in feature.items().items() if name not in ("fid", "id")}
        found.append((feature.GetGeometryRef().ExportToWkt(), values))
    return sorted(found, key=str)


def gdal_source(url):
    at = make_url(url)
    words = f"host={at.host} port={at.port} dbname={at.database} user={at.username} password={at.password}"
    return ogr.Open(f"PG:{words} schemas=site_sample")


def qgis_uri(url) -> QgsDataSourceUri:
    at, uri = make_url(url), QgsDataSourceUri()
    uri.setConnection(at.host, str(at.port), at.database, at.username, at.password)
    return uri


def test_a_script_publishes_the_sample_site_which_is_the_same_as_in_a_folder(
    by_words, sample, database, tmp_path
):
    words = (f"DATABASE={database}", f"FOLDER={tmp_path / 'site'}")
    done = by_words("run", "fleet:publishsite", f"--PROJECT_PATH={sample}", "--", *words)
    assert done.status == 0, done.said
    assert "is published in the database, schema site_sample" in done.said
    assert files_in(database, "sample") == {
        name: (tmp_path / "site" / name).read_bytes() for name in SITE_FILES
    }
    folder, source = ogr.Open(str(tmp_path / "site" / "site.gpkg")), gdal_source(database)
    for name in LAYERS:
        assert shapes(source.GetLayerByName(name)) == shapes(folder.GetLayerByName(name)), name
    assert source.GetLayerByName("obstacles").GetSpatialRef().GetAuthorityCode(None) == "32633"
    uri = qgis_uri(database)
    uri.setDataSource("site_sample", "keepouts", "geom", "", "id")
    layer = QgsVectorLayer(uri.uri(False), "keepouts", "postgres")
    assert layer.isValid() and layer.crs().authid() == "EPSG:32633" and layer.featureCount() > 0
    copy = SiteCopy(read_site_address(f"{database}#sample"), tmp_path / "state")
    copy.fetch_first()
    served = read_site(copy.folder)
    assert (served.id, served.version) == ("sample", 1) and served.cache is not None


def test_a_new_version_takes_the_place_of_the_earlier_one_for_all_that_read_it(publish, database, tmp_path):
    results = publish(DATABASE=database, STALE_AFTER=3, LOST_AFTER=9)
    assert (results["VERSION"], results["SCHEMA"]) == (1, "site_yard") and "FOLDER" not in results
    run(
        database,
        "grant usage on schema site_yard to public",
        "grant select on all tables in schema site_yard to public",
        "create view site_yard.mine as select * from site_yard.obstacles",
    )
    results = publish(DATABASE=database)
    assert results["VERSION"] == 2
    assert schemas(database) == {"site_yard", "site_yard@2"}
    assert rows(database, "select count(*) from site_yard.mine") == [(1,)]
    ((site, version, digest),) = rows(database, "select site, version, digest from fleet_sites.sites")
    listed = rows(database, "select name, size, digest from fleet_sites.files order by name")
    files = files_in(database, "yard")
    assert listed == [
        (name, len(files[name]), hashlib.sha256(files[name]).hexdigest()) for name in sorted(files)
    ]
    text = "".join(f"{of_file}  {name}\n" for name, _, of_file in listed).encode()
    assert (site, version, digest) == ("yard", 2, hashlib.sha256(text).hexdigest())
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    served = read_site(tmp_path)
    assert served.version == 2 and served.cache is not None
    # What was not given stays as it was published.
    assert (served.settings.liveness.stale_after_s, served.settings.liveness.lost_after_s) == (3.0, 9.0)


def test_another_crs_makes_the_views_again_for_those_who_may_read_them(publish, database):
    publish(DATABASE=database)
    run(database, "grant select on site_yard.obstacles to public")
    publish(DATABASE=database, SITE_CRS="EPSG:32632", LOCAL=True, ORIGIN="0,0")
    query = "select srid from geometry_columns where f_table_schema = 'site_yard'"
    assert rows(database, query) == [(32632,)] * 4
    query = "select has_table_privilege('public', 'site_yard.obstacles', 'select')"
    assert rows(database, query) == [(True,)]


def test_the_folder_and_the_database_go_on_with_the_higher_version_and_both_or_none_changes(
    publish, database, tmp_path, monkeypatch
):
    monkeypatch.setattr(postgis_publication, "LOCKED_FOR_S", 1)
    folder = tmp_path / "site"
    publish(DATABASE=database)
    results = publish(DATABASE=database, FOLDER=str(folder))
    assert results["VERSION"] == 2 and read_site(folder).version == 2
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    with closing(psycopg.connect(database)) as other:
        other.execute("lock table site_yard.obstacles in access share mode")
        with pytest.raises(QgsProcessingException, match="Somebody has read or written yard"):
            publish(DATABASE=database, FOLDER=str(folder))
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == before
    assert rows(database, "select version from fleet_sites.sites") == [(2,)]
    assert publish(DATABASE=database, FOLDER=str(folder))["VERSION"] == 3


def test_a_cancel_leaves_the_database_as_it_was(publish, database, cancels_at):
    publish(DATABASE=database)
    assert publish(cancels_at(50), DATABASE=database) == {}
    assert rows(database, "select version from fleet_sites.sites") == [(1,)]
    assert schemas(database) == {"site_yard", "site_yard@1"}


def test_two_at_a_time_are_one_and_a_refusal(publish, database, tmp_path, listener):
    folder = tmp_path / "site"
    publish(DATABASE=database, FOLDER=str(folder))
    with (
        pytest.raises(PublicationError, match=r"Another publication of yard .* publish again"),
        postgis_publication.site_database(database, "yard") as late,
    ):
        settings = replace(read_settings(folder / SETTINGS_FILE), version=late.version + 1)
        assert publish(DATABASE=database)["VERSION"] == 2
        with late.new_version(settings, folder, listener):
            pytest.fail("two at once")
    assert rows(database, "select version from fleet_sites.sites") == [(2,)]


def test_a_database_without_postgis_says_what_to_install(publish, postgis_server):
    with pytest.raises(QgsProcessingException, match=r"has no PostGIS.*postgis.*create extension postgis"):
        publish(DATABASE=postgis_server.new_database())


def test_an_account_that_may_make_no_schema_is_given_the_statement(publish, postgis_server, database):
    at = make_url(database)
    name = f"guest_{at.database[-6:]}"
    postgis_server.sql(f"create role \"{name}\" login password 'Guest'", at.database)
    guest = at.set(username=name, password="Guest").render_as_string(hide_password=False)
    command = f'grant create on database "{at.database}" to "{name}"'
    with pytest.raises(QgsProcessingException, match=command):
        publish(DATABASE=guest)
    postgis_server.sql(command, at.database)
    publish(DATABASE=database)
    with pytest.raises(QgsProcessingException, match=f'belong to the account {at.username}.*grant "'):
        publish(DATABASE=guest)
    postgis_server.sql(f'drop owned by "{name}"; drop role "{name}"', at.database)


def test_a_schema_of_another_version_is_left_alone(publish, database):
    run(database, "create schema fleet_sites", f"comment on schema fleet_sites is '{FORMAT}9'")
    with pytest.raises(QgsProcessingException, match=f"of another version.*{FORMAT}9.*another database"):
        publish(DATABASE=database)
    assert schemas(database) == set()


def test_a_server_that_is_not_there_is_named(publish):
    with pytest.raises(QgsProcessingException, match=r"cannot be reached.*Connection refused.*Check that it"):
        publish(DATABASE="postgresql://anna@127.0.0.1:9/nothing")


def test_a_connection_of_qgis_is_taken_by_its_name_and_one_that_is_not_there_named(publish, database):
    kinds = QgsProviderRegistry.instance().providerMetadata("postgres")
    kept = {"saveUsername": True, "savePassword": True}
    kinds.saveConnection(kinds.createConnection(qgis_uri(database).uri(False), kept), "yards")
    try:
        assert publish(DATABASE="yards")["VERSION"] == 1
        with pytest.raises(
            QgsProcessingException, match=r"no PostgreSQL connection barn; it has: yards. Make it"
        ):
            publish(DATABASE="barn")
    finally:
        kinds.deleteConnection("yards")


def test_a_layer_whose_table_is_gone_is_named_without_the_password(publish, database):
    uri = qgis_uri(database)
    uri.setDataSource("public", "houses", "geom", "", "id")
    gone = QgsVectorLayer(uri.uri(False), "houses", "postgres")
    keep_setup(gone, LayerSetup("obstacle", LayerExpressions()))
    project = QgsProject()
    project.addMapLayer(gone)
    with pytest.raises(QgsProcessingException, match=r"The layer houses cannot be opened.*repair") as told:
        publish(DATABASE=database, OBSTACLES=None, project=project)
    assert make_url(database).password not in str(told.value)
    assert schemas(database) == set()


def test_nowhere_to_publish_is_said(publish):
    with pytest.raises(QgsProcessingException, match=r"It is not said where to publish.*FOLDER.*DATABASE"):
        publish()
