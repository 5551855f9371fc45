"""What the bridge's tests share: the sample site, real programs and database servers."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

import pytest
from sqlalchemy import Connection, Engine, event


class SharedStatements(dict):
    """What SQLAlchemy compiled, for all engines on databases of one kind and version.

    Each test has an engine of its own, and to compile its statements takes longer than to execute them.
    """

    def get(self, key, default=None):
        return super().get(self._common(key), default)

    def __setitem__(self, key, compiled):
        super().__setitem__(self._common(key), compiled)

    @staticmethod
    def _common(key):
        dialect, *rest = key
        return type(dialect), dialect.server_version_info, *rest


STATEMENTS = SharedStatements()


@event.listens_for(Engine, "engine_connect")
def share_statements(connection: Connection) -> None:
    connection.execution_options(compiled_cache=STATEMENTS)


@pytest.fixture(scope="session")
def sample_site(root) -> Path:
    """The folder of the published sample site: 200 m × 160 m, reached within 0.20 m."""
    return root / "resources" / "sample_site"


@pytest.fixture(scope="module")
def impatient_site(sample_site, tmp_path_factory) -> Path:
    """The same site, on which a robot is stale after 0.8 s and lost after 1.6 s."""
    return _patient_for(sample_site, tmp_path_factory.mktemp("impatient"), 0.8, 1.6)


@pytest.fixture(scope="module")
def giving_up_site(sample_site, tmp_path_factory) -> Path:
    """The same site, on which a robot is lost after 4 s in place of 10, soon after it is stale."""
    return _patient_for(sample_site, tmp_path_factory.mktemp("giving-up"), 3.0, 4.0)


def _patient_for(site: Path, folder: Path, stale: float, lost: float) -> Path:
    shutil.copy(site / "site.gpkg", folder)
    text = (site / "site.toml").read_text(encoding="utf-8")
    text = text.replace("stale_after_s = 3.0", f"stale_after_s = {stale}")
    text = text.replace("lost_after_s = 10.0", f"lost_after_s = {lost}")
    (folder / "site.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def limited_site(sample_site, tmp_path_factory):
    """Make a copy of the sample site with more lines in its site.toml: ``limited_site(text)``."""

    def make(text: str) -> Path:
        folder = tmp_path_factory.mktemp("site")
        shutil.copy(sample_site / "site.gpkg", folder)
        settings = (sample_site / "site.toml").read_text(encoding="utf-8")
        (folder / "site.toml").write_text(f"{settings}\n{text}\n", encoding="utf-8")
        return folder

    return make


@pytest.fixture(scope="module")
def accounts_of():
    """The command line on a bridge's database: ``accounts_of(bridge)``."""
    from tests.support.bridge.bridge_accounts import Accounts

    return lambda bridge: Accounts(bridge.database)


@pytest.fixture(scope="module")
def start_bridge(tmp_path_factory, new_database):
    """Start a gateway: ``start_bridge(site)``, or ``start_bridge(site, url)``; all ends with the module."""
    from tests.support.bridge.bridge_programs import Bridge
    from tests.support.processes import Processes

    folder = tmp_path_factory.mktemp("bridge")
    with Processes(folder / "logs") as processes:
        bridges = []

        def start(site, database: str | None = None, options=()) -> Bridge:
            bridge = Bridge(processes, site, database or new_database("sqlite"))
            bridge.options += options
            if "--state" not in bridge.options and not bridge.database.startswith("sqlite"):
                # Else what gateways note goes beside the site, which may be a folder of the repository.
                (state := folder / f"state-{len(bridges)}").mkdir()
                bridge.options += ["--state", state]
            bridges.append(bridge)
            try:
                bridge.start_gateway()
            except BaseException:  # a gateway that came too late would hold the next test's database
                bridge.end()
                raise
            return bridge

        yield start
        for bridge in bridges:
            bridge.hang_up()
            assert "Traceback" not in bridge.output(), bridge.output()


@pytest.fixture(autouse=True)
def _end_with_the_test(request):
    """End what a test has started for itself alone, before the next one begins."""
    if "start_bridge" not in request.fixturenames:
        yield
        return
    from tests.support.bridge.bridge_programs import Bridge

    for bridge in Bridge.open_ones:
        bridge.begin_test()
    yield
    for bridge in list(Bridge.open_ones):
        bridge.end_test()


@pytest.fixture(scope="session")
def forking_command(tmp_path_factory) -> Path:
    """``robot-bridge`` as a command of its own, for pipes and shells, that loads no modules."""
    from tests.support.forked_programs import write_shell_command

    file = tmp_path_factory.mktemp("command") / "robot-bridge"
    write_shell_command(file)
    return file


@pytest.fixture
def postgresql_url(postgresql_server) -> str:
    """A new, empty PostgreSQL database: the URL of the account that owns it, which is no superuser."""
    return postgresql_server.new_database()


@pytest.fixture
def mariadb_url(mariadb_server) -> str:
    """A new, empty MariaDB database: the URL of the account that has all rights on it and none elsewhere."""
    return mariadb_server.new_database()


@pytest.fixture(scope="session")
def new_database(request):
    """Make a database with the tables and nothing in them: ``new_database("postgresql")`` returns its URL.

    Files of SQLite lie in memory where there is a folder of it: none need outlive a power cut.
    """
    from tests.support.databases.database_maker import DatabaseMaker

    memory = Path("/dev/shm")
    quick = memory if os.access(memory, os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="fleet-databases-", dir=quick) as folder:
        maker = DatabaseMaker(Path(folder), lambda kind: request.getfixturevalue(f"{kind}_server"))
        yield maker
        maker.close()
