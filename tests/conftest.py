"""What all tests share: the plugin's package name and where the real data lies."""

from __future__ import annotations

import functools
import gc
import importlib.util
import os
import re
import signal
import sys
from collections import defaultdict, deque
from pathlib import Path
from zlib import crc32

import pytest
from hypothesis import HealthCheck, settings

from tests.support import file_by_file
from tests.support.processes import Processes

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data"
YOUNG, MIDDLE, OLD = 20_000, 10, 20
"""Objects, and rounds, before Python next looks for those that hold each other."""
LAST_LINES = 30
"""of what a program printed, in the report of a test that failed."""


def register_plugin_package():
    """Make the repository's root importable under the name that QGIS gives it."""
    if "fleet_supervisor" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "fleet_supervisor", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["fleet_supervisor"] = module
    spec.loader.exec_module(module)


register_plugin_package()


def keep_bytecode():
    """Have Python keep what it compiled of tests and programs, also where the environment says not to.

    Else every worker compiles all tests again, and every program that they start all of itself.
    """
    sys.dont_write_bytecode = False
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


keep_bytecode()


def trust_nobody():
    """Have nobody read the certificates of public authorities: no test connects to whom they certify.

    Where the environment names a file of them, each connection to MariaDB takes 20 ms to read it.
    """
    os.environ["SSL_CERT_FILE"] = os.devnull


trust_nobody()


def hear_signals():
    """Have the programs that tests start hear SIGINT and SIGHUP, whatever this process was started to ignore.

    A shell ignores SIGINT for what runs in its background, nohup SIGHUP; programs inherit that. A handler of
    this process is none of theirs: they begin with the default.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: None)


hear_signals()

# How long something takes on a busy machine says nothing of whether it is right.
settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
# make test-core shows in a minute that nothing is broken; make test looks for the rare example, by others in
# each run, and make test-release for twice as many.
settings.register_profile("core", settings.get_profile("any machine"), max_examples=30)
settings.register_profile("each run", settings.get_profile("any machine"), max_examples=50)
settings.load_profile("each run")


# --- make test-core: what needs neither QGIS nor database servers nor a display, nor programs of its own ---

NOT_CORE = (
    "packaging",
    "plugin",
    "robot_bridge/cli",
    "robot_bridge/core/assignment",
    "robot_bridge/core/robotmap/exporters/test_any_map.py",
    "robot_bridge/core/robotmap/test_hostile_maps.py",
    "robot_bridge/core/robotmap/test_progress_monitor.py",
    "robot_bridge/core/sites/test_cache_writing.py",
    "robot_bridge/faults",
    "robot_bridge/gateway/auth",
    "robot_bridge/gateway/fleet/crashes",
    "robot_bridge/gateway/fleet/test_big_site.py",
    "robot_bridge/gateway/fleet/test_one_in_trouble.py",
    "robot_bridge/gateway/fleet/test_pausing.py",
    "robot_bridge/gateway/fleet/test_short_lives.py",
    "robot_bridge/gateway/fleet/test_stop_despite_rows.py",
    "robot_bridge/gateway/monitoring/test_garbage.py",
    "robot_bridge/gateway/plans",
    "robot_bridge/gateway/storage/databases",
    "robot_bridge/gateway/storage/roles",
    "robot_bridge/gateway/traffic/test_conflicts.py",
    "robot_bridge/gateway/traffic/test_route_process.py",
    "robot_bridge/gateway/trajectories",
    "robot_bridge/links/ros2/test_dds_with_rclpy.py",
    "robot_bridge/links/vda5050/test_broker.py",
    "robot_bridge/links/vda5050/test_guide.py",
    "robot_bridge/links/vda5050/test_live.py",
    "robot_bridge/live",
    "robot_bridge/protocol/test_asyncapi.py",
    "robot_bridge/recordings/test_bags.py",
    "robot_bridge/reference_robot/test_experiments.py",
    "robot_bridge/reference_robot/test_localised_robot.py",
    "robot_bridge/reference_robot/test_map_gaps.py",
    "robot_bridge/reference_robot/test_particle_filter.py",
    "robot_bridge/reference_robot/test_ray_casting.py",
    "robot_bridge/reference_robot/test_served_experiment.py",
)
"""Tests that take long, or need more than Python."""
NOT_CORE_PATHS = {ROOT / "tests" / name for name in NOT_CORE}
MORE_THAN_CORE = {"start_bridge", "postgresql_server", "mariadb_server", "nats", "data"}
"""Fixtures that start programs, or read much."""
SERVERS = {"postgresql", "mariadb", "nats"}
KINDS = {"sqlite", *SERVERS}
GIS = re.compile(r"^\s*(?:from|import) (?:qgis|osgeo|PyQt5)\b", re.MULTILINE)


@pytest.hookimpl(hookwrapper=True)
def pytest_collection(session):
    """Have nobody look for objects to remove while all tests are read in, nor later at what that has made.

    It is half a million objects that last: each look at them takes a quarter of a second. The looks at what
    tests make are rarer than Python's own, which take a twentieth of all tests' time.
    """
    gc.disable()
    yield
    gc.enable()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)


def pytest_addoption(parser):
    parser.addoption("--core", action="store_true", help="run only what needs no QGIS, no server, no display")
    parser.addoption(
        "--release", action="store_true", help="repeat tests on everything; what would be skipped fails"
    )


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "again(shown): run for a release only; what shows the same in every run, on something else"
    )
    if config.getoption("--core"):
        # Whoever imports it all the same fails.
        sys.modules["qgis"] = sys.modules["osgeo"] = None
        settings.load_profile("core")
    elif config.getoption("--release"):
        settings.load_profile("any machine")
    file_by_file.begin(config, deal_out)


def pytest_ignore_collect(collection_path, config):
    if not config.getoption("--core"):
        return None
    if not NOT_CORE_PATHS.isdisjoint((collection_path, *collection_path.parents)):
        return True
    is_test = collection_path.match("test_*.py")
    return True if is_test and GIS.search(collection_path.read_text(encoding="utf-8")) else None


def is_core(item) -> bool:
    """Whether a test needs no server and no program of its own."""
    values = getattr(item, "callspec", None)
    on_server = values is not None and not SERVERS.isdisjoint(map(str, values.params.values()))
    return not on_server and MORE_THAN_CORE.isdisjoint(item.fixturenames)


def pytest_collection_modifyitems(config, items):
    """Select what is asked for, and put the files in order."""
    chosen = items
    if config.getoption("--core"):
        chosen = [item for item in items if is_core(item)]
    elif not config.getoption("--release"):
        chosen = in_turn([item for item in items if item.get_closest_marker("again") is None])
    kept = set(chosen)
    config.hook.pytest_deselected(items=[item for item in items if item not in kept])
    items[:] = chosen
    deal_out(items)


# --- make test: one database server in turn, where the other does nothing of its own ---

IN_TURN = (
    "robot_bridge/cli/test_sole_gateway.py",
    "robot_bridge/cli/test_trouble.py",
    "robot_bridge/gateway/api",
    "robot_bridge/gateway/commands",
    "robot_bridge/gateway/fleet",
    "robot_bridge/gateway/plans",
    "robot_bridge/gateway/queues",
    "robot_bridge/gateway/storage/databases/test_bridge_on_each.py",
    "robot_bridge/gateway/storage/databases/test_operations_on_each.py",
    "robot_bridge/gateway/traffic",
    "robot_bridge/gateway/trajectories",
    "robot_bridge/live",
)
"""Tests of what the gateway does with its database; what a server decides by itself is in storage."""
IN_TURN_PATHS = {ROOT / "tests" / name for name in IN_TURN}
SELDOM_ON_SERVERS = tuple(f"robot_bridge/gateway/{name}" for name in ("commands", "fleet", "plans", "queues"))
"""Those of rules that are stored the same way wherever that is; they are run on SQLite as well."""
SELDOM_PATHS = {ROOT / "tests" / name for name in SELDOM_ON_SERVERS}
STOPS = re.compile(r"stop|abort|paus|emergency")
"""What is run on both servers, whatever it has to do with them."""


def in_turn(items):
    """Leave one of two tests that differ by their database server alone: half of them on each.

    Where it is seldom the server's doing, every second test that is run on SQLite is run on no server.
    """
    groups = defaultdict(dict)
    for item in items:
        values = getattr(item, "callspec", None)
        kinds = KINDS.intersection(map(str, values.params.values())) if values is not None else ()
        for kind in kinds if may_rest(item) else ():
            groups[item.nodeid.replace(kind, "KIND")][kind] = item
    resting = set()
    for name, on in groups.items():
        turn, servers = crc32(name.encode()) % 4, sorted(on.keys() & SERVERS)
        if len(servers) == 2:
            seldom = "sqlite" in on and is_in(on["sqlite"], SELDOM_PATHS)
            resting.update(on[kind] for kind in servers if kind != servers[turn % 2] or (seldom and turn > 1))
    return [item for item in items if item not in resting]


def may_rest(item) -> bool:
    """Whether what a test shows on one database server it need not show on the other in each run."""
    return is_in(item, IN_TURN_PATHS) and STOPS.search(item.nodeid) is None


def is_in(item, paths) -> bool:
    """Whether a test is in one of the files or folders."""
    return not paths.isdisjoint(folders_of(item.path))


@functools.cache
def folders_of(path: Path) -> tuple[Path, ...]:
    """Return the path and all folders that it is in."""
    return path, *path.parents


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    """Have a failure say what its programs printed last.

    A test that is skipped fails in a run for a release: its machine has everything.
    """
    report = (yield).get_result()
    if report.failed:
        report.sections += [part for one in Processes.open_ones for part in one.reports(LAST_LINES)]
    if item.config.getoption("--release") and report.skipped and not hasattr(report, "wasxfail"):
        report.outcome, report.longrepr = "failed", f"skipped: {report.longrepr[2]}"


LONG = (
    "plugin/test_endurance.py",
    "robot_bridge/gateway/fleet/crashes/test_crashes.py",
    "plugin/loop/test_roads.py",
    "robot_bridge/live/test_queues.py",
    "robot_bridge/links/ros2/test_ros2_live.py",
    "robot_bridge/gateway/storage/databases/test_bridge_on_each.py",
    "robot_bridge/gateway/storage/databases/test_stop_on_each.py",
    "robot_bridge/live/test_restarts.py",
    "robot_bridge/gateway/cluster/test_plans_across.py",
    "robot_bridge/gateway/cluster/test_older_databases.py",
    "plugin/loop/test_cone_plan.py",
    "plugin/language/test_room_for_words.py",
    "packaging/test_walkthrough.py",
    "plugin/loop/test_queue.py",
    "plugin/loop/test_linked_robots.py",
    "robot_bridge/cli/test_choosing_a_site.py",
    "packaging/test_qgis4.py",
    "robot_bridge/cli/test_backup.py",
    "packaging/test_style.py",
    "plugin/panel/alarms/test_alarms_at_desk.py",
    "robot_bridge/cli/test_gateway_as_service.py",
    "packaging/test_appliance.py",
    "packaging/test_demonstrations.py",
    "packaging/test_zalazone.py",
    "robot_bridge/faults/test_faults.py",
    "robot_bridge/live/test_pausing.py",
    "robot_bridge/gateway/storage/roles/test_sql_sessions.py",
    "robot_bridge/links/rosbridge/test_rosbridge_live.py",
    "robot_bridge/links/vda5050/test_live_restarts.py",
    "robot_bridge/links/vda5050/test_live.py",
    "robot_bridge/links/vda5050/test_network_cut.py",
    "robot_bridge/links/ros2/test_ros2_security.py",
    "robot_bridge/live/test_two_robots.py",
    "plugin/loop/test_whole_loop.py",
    "robot_bridge/live/test_gateway_starts.py",
    "plugin/map/test_memory.py",
    "robot_bridge/cli/test_trouble.py",
    "robot_bridge/cli/test_sole_gateway.py",
    "plugin/processing/test_qgis_process.py",
    "robot_bridge/gateway/storage/databases/test_servers_that_fail.py",
    "robot_bridge/live/test_geofence.py",
    "robot_bridge/live/test_emergency_stop.py",
)
"""Files that take a minute beside five other workers, however many tests they have; the longest first."""


def deal_out(items):
    """Deal out the files with many tests and those with few by turns, and before each a long one.

    Those with many compute, those with few wait for real windows, databases and robots: workers that run one
    kind all at once would first fight for the processors and then leave them idle. A long one that came late
    would be waited for alone.
    """
    files = {}
    for item in items:
        files.setdefault(item.path, []).append(item)
    long = deque(filter(None, (files.pop(ROOT / "tests" / name, None) for name in LONG)))
    # A file that is not read in yet is one item, and the longer it is, the more tests it has.
    by_tests = sorted(files.items(), key=lambda file: (len(file[1]), file[0].stat().st_size), reverse=True)
    waiting = deque(tests for _, tests in by_tests)
    items.clear()
    while long or waiting:
        if long:
            items += long.popleft()
        if waiting:
            items += waiting.popleft() if len(waiting) % 2 else waiting.pop()


@pytest.fixture
def qgis_show_map(request) -> None:
    """Show no map, in place of pytest-qgis, which has each test make and remove a folder for it.

    That it asks for ``request`` has pytest-qgis tidy up what layers a test has.
    """


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository's root, which is the plugin's folder."""
    return ROOT


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real data beside the project (see its README)."""
    if not DATA.is_dir():
        pytest.skip(f"the real data is not on this machine: {DATA} does not exist")
    return DATA


@pytest.fixture(scope="session")
def postgresql_server():
    """A real PostgreSQL of these tests' own, which can make databases, be killed and come back."""
    from tests.support.databases.postgresql import PostgreSql

    yield from _serving(PostgreSql())


@pytest.fixture(scope="session")
def mariadb_server():
    """A real MariaDB of these tests' own; as ``postgresql_server``."""
    from tests.support.databases.mariadb import MariaDb

    yield from _serving(MariaDb())


def _serving(server):
    from tests.support.errors import StageError

    try:
        server.require_programs()
    except StageError as error:
        pytest.skip(str(error))
    with server:
        yield server


@pytest.fixture(scope="session")
def postgis_server(postgresql_server):
    """The same, where PostGIS is installed."""
    if "postgis" not in postgresql_server.sql("select name from pg_available_extensions"):
        pytest.skip("PostGIS is not installed; run: make setup")
    return postgresql_server
