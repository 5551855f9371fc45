"""A gateway whose site is published in a database: fetched, followed, and served on while that is away."""

from __future__ import annotations

import asyncio
import hashlib
import json
import os
import signal
import socket
import time
import urllib.request
from contextlib import closing
from dataclasses import replace

import psycopg
import pytest
from psycopg.pq import TransactionStatus
from sqlalchemy import make_url

from robot_bridge.core.errors import SiteError
from robot_bridge.core.sites.settings import SETTINGS_FILE, read_settings
from robot_bridge.core.sites.site import read_site, write_site
from robot_bridge.core.sites.site_database import SITE_FILES, TABLES, digest_text, read_site_address
from robot_bridge.gateway.site_updates import SiteCopy, SiteCopyError
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.command_line import run_command
from tests.support.patience import BUSY, START
from tests.support.processes import Processes, freeze


@pytest.fixture(scope="module")
def server_url(postgresql_server):
    """One database for all tests; what they publish is removed behind each."""
    return postgresql_server.new_database()


@pytest.fixture
def database(server_url):
    yield server_url
    with closing(psycopg.connect(server_url, autocommit=True)) as connection:
        connection.execute("drop schema if exists fleet_sites cascade")


@pytest.fixture
def address(database, site):
    """The address of the sample site, which is published."""
    put(database, site)
    return f"{database}#sample"


def put(url, folder):
    """Do what the plugin does: write the files of ``folder``, and switch to them, at once."""
    settings = read_settings(folder / SETTINGS_FILE)
    contents = {name: (folder / name).read_bytes() for name in SITE_FILES if (folder / name).is_file()}
    digests = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    with closing(psycopg.connect(url)) as connection, connection.transaction():
        if connection.execute("select to_regclass('fleet_sites.sites')").fetchone() == (None,):
            connection.execute(TABLES)
        for table in ("sites", "files", "parts"):
            connection.execute(f"delete from fleet_sites.{table} where site = %s", [settings.id])
        key = (settings.id, settings.version)
        whole = hashlib.sha256(digest_text(digests)).hexdigest()
        connection.execute("insert into fleet_sites.sites values (%s, %s, %s)", [*key, whole])
        for name, content in contents.items():
            row = [*key, name, len(content), digests[name]]
            connection.execute("insert into fleet_sites.files values (%s, %s, %s, %s, %s)", row)
            half = len(content) // 2
            for number, part in enumerate((content[:half], content[half:])):
                row = [*key, name, number, part]
                connection.execute("insert into fleet_sites.parts values (%s, %s, %s, %s, %s)", row)


def publish_again(folder):
    site = read_site(folder)
    settings = replace(site.settings, version=site.version + 1)
    write_site(folder, settings, site.outlines, site.centrelines, site.surfaces, site.keepouts)


def version_served(bridge):
    with urllib.request.urlopen(f"{bridge.address.replace('ws:', 'http:')}/healthz", timeout=60) as answer:
        return json.loads(answer.read())["site"]["version"]


def run(url, statement):
    with closing(psycopg.connect(url, autocommit=True)) as connection:
        connection.execute(statement)


def test_a_gateway_serves_it_follows_it_and_goes_on_without_the_database(
    start_bridge, address, database, site, tmp_path, postgresql_server
):
    bridge = start_bridge(address, options=("--state", tmp_path / "state"))
    assert version_served(bridge) == 1
    publish_again(site)
    put(database, site)
    wait_until(lambda: version_served(bridge) == 2)
    postgresql_server.kill()
    try:
        wait_until(lambda: "site copy: postgresql://" in bridge.output())
        assert version_served(bridge) == 2
        bridge.gateway.terminate()
        # Within its own limit, after which it would end by force and say so.
        assert bridge.gateway.wait(START) == 0
        bridge.start_gateway()
        assert version_served(bridge) == 2
        wait_until(lambda: "its version 2, which was fetched before, is served" in bridge.output())
    finally:
        postgresql_server.start()
    publish_again(site)
    put(database, site)
    wait_until(lambda: version_served(bridge) == 3)
    bridge.end()
    password = make_url(database).password
    assert password not in bridge.output()


def test_what_is_fetched_is_what_was_published_and_fetched_once(address, site, tmp_path):
    copy = SiteCopy(read_site_address(address), tmp_path)
    copy.fetch_first()
    names = {file.name for file in site.iterdir()}
    assert {file.name: file.read_bytes() for file in copy.folder.iterdir()} == {
        name: (site / name).read_bytes() for name in names
    }
    before = (copy.folder / SETTINGS_FILE).stat()
    SiteCopy(read_site_address(address), tmp_path).fetch_first()
    assert (copy.folder / SETTINGS_FILE).stat() == before


def test_what_is_damaged_there_is_refused_and_the_earlier_one_stays(
    address, database, site, tmp_path, caplog
):
    copy = SiteCopy(read_site_address(address), tmp_path)
    copy.fetch_first()
    publish_again(site)
    put(database, site)
    run(database, "update fleet_sites.parts set content = content || 'x' where name = 'site.gpkg'")
    copy.fetch_first()
    assert "site.gpkg of version 2 is damaged" in caplog.text and "its version 1" in caplog.text
    assert read_site(copy.folder).version == 1
    with pytest.raises(SiteCopyError, match=r"version 2 is damaged.*publish the site again"):
        SiteCopy(read_site_address(address), tmp_path / "elsewhere").fetch_first()


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("drop schema fleet_sites cascade", "no site is published in this database; publish it there"),
        ("update fleet_sites.sites set site = 'barn'", "there is no site 'sample' .*; it has: barn"),
        ("comment on schema fleet_sites is 'format 9'", "of another version of this program.*'format 9'"),
    ],
)  # fmt: skip
def test_a_database_that_has_it_not_says_what_to_do(address, database, tmp_path, statement, said):
    run(database, statement)
    with pytest.raises(SiteCopyError, match=said):
        SiteCopy(read_site_address(address), tmp_path).fetch_first()


def test_an_account_that_may_not_read_it_is_given_the_grants(address, database, tmp_path, postgresql_server):
    postgresql_server.sql("create role onlooker login password 'Looking-on'")
    url = make_url(address).set(username="onlooker", password="Looking-on")
    given = url.render_as_string(hide_password=False).replace("%23", "#")
    copy = SiteCopy(read_site_address(given), tmp_path)
    with pytest.raises(SiteCopyError, match="grant usage on schema fleet_sites to ACCOUNT") as told:
        copy.fetch_first()
    assert "Looking-on" not in str(told.value)
    run(database, "grant usage on schema fleet_sites to onlooker")
    run(database, "grant select on all tables in schema fleet_sites to onlooker")
    copy.fetch_first()
    assert read_site(copy.folder).version == 1
    run(database, "drop schema fleet_sites cascade")
    postgresql_server.sql("drop role onlooker")


def test_a_server_that_is_not_there_is_named(tmp_path):
    with pytest.raises(
        SiteCopyError, match=r"postgresql://anna@127.0.0.1:9/yards#yard cannot be read.*refused"
    ):
        SiteCopy(read_site_address("postgresql://anna:Secret@127.0.0.1:9/yards#yard"), tmp_path).fetch_first()


def test_a_server_that_says_nothing_holds_up_no_stop(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as silent, Processes(tmp_path / "logs") as processes:
        silent.settimeout(START)
        where = f"postgresql://anna@127.0.0.1:{silent.getsockname()[1]}/yards#yard"
        process = processes.start_bridge("gateway", ["serve", "--site", where, "--state", tmp_path])
        with silent.accept()[0]:
            process.send_signal(signal.SIGTERM)
            assert process.wait(START) == -signal.SIGTERM


def test_views_of_the_fleet_take_their_frame_from_it(address, new_database):
    done = run_command("database", "views", "--site", address, "--database", new_database("sqlite"))
    assert done.returncode == 0, done.stderr
    assert "made map_robots" in done.stdout


def test_an_experiment_is_driven_on_it(address, tmp_path):
    (tmp_path / "short.toml").write_text("route = [[20, 20], [22, 20]]\n[filter]\nleast = 200\n", "utf-8")
    done = run_command("experiment", tmp_path / "short.toml", "--site", address, "--seeds", "1")
    assert done.returncode == 0 and "| 1 | 1.9 |" in done.stdout, done


@pytest.mark.parametrize("command", ["trajectories", "placements"])
def test_what_is_exported_takes_its_frame_from_it(command, address, new_database, tmp_path):
    words = (command, "export", tmp_path / "out.gpkg", "--site", address)
    done = run_command(*words, "--database", new_database("sqlite"))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out.gpkg").is_file()


def test_the_doctor_checks_it(address, new_database):
    done = run_command("doctor", "--site", address, "--database", new_database("sqlite"), "--port", 1)
    assert "version 1, 47 obstacles" in done.stdout, done


async def test_a_server_that_is_frozen_holds_up_no_stop(address, tmp_path, postgresql_server):
    copy = SiteCopy(read_site_address(address), tmp_path)
    await copy.refresh()
    backend = copy._connection.info.backend_pid
    freeze(backend)
    try:
        looking = asyncio.create_task(copy.refresh())
        while copy._connection.info.transaction_status != TransactionStatus.ACTIVE:
            await asyncio.sleep(0)
        began = time.monotonic()
        looking.cancel()
        with pytest.raises(asyncio.CancelledError):
            await looking
        await copy.close()
        assert time.monotonic() - began < BUSY
    finally:
        os.kill(backend, signal.SIGCONT)


@pytest.mark.parametrize(
    "text", ["postgresql://db/yards", "postgresql://db/yards#", "postgres://db/yards#a/../b"]
)
def test_an_address_that_names_no_site_is_refused(text):
    with pytest.raises(SiteError, match="names no site: write it like postgresql://"):
        read_site_address(text)
