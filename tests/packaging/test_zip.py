"""The zip is what plugins.qgis.org accepts (its rules: docs.qgis.org, "Releasing your plugin")."""

from __future__ import annotations

import re
import shutil
import subprocess
import zipfile
from configparser import ConfigParser
from pathlib import PurePosixPath

import pytest

from tools.package import LIMIT, build
from tools.plugin_files import PackageError, plugin_files, version

REQUIRED_KEYS = (
    "name",
    "qgisMinimumVersion",
    "description",
    "about",
    "version",
    "author",
    "email",
)
BINARIES = (".so", ".pyd", ".dll", ".dylib", ".exe", ".pyc", ".pyo", ".a", ".o", ".whl", ".c")


@pytest.fixture(scope="module")
def names(release):
    with zipfile.ZipFile(release) as archive:
        return archive.namelist()


@pytest.fixture(scope="module")
def metadata(release):
    parser = ConfigParser(interpolation=None)
    parser.optionxform = str
    with zipfile.ZipFile(release) as archive:
        parser.read_string(archive.read("fleet_supervisor/metadata.txt").decode("utf-8"))
    return parser["general"]


def test_one_folder_holds_everything(names):
    assert {PurePosixPath(name).parts[0] for name in names} == {"fleet_supervisor"}
    assert {"metadata.txt", "__init__.py", "LICENSE"} <= {name.split("/", 1)[1] for name in names}


def test_no_binary_no_test_no_hidden_file_is_in_it(names):
    assert not [name for name in names if name.endswith(BINARIES)]
    parts = {part for name in names for part in PurePosixPath(name).parts}
    assert not parts & {"__pycache__", "__MACOSX", "tests", "benchmarks", ".git"}
    # plugin/map/tools are the tools of the map; those of developers lie at the top.
    assert not {PurePosixPath(name).parts[1] for name in names} & {"tools"}
    assert {part for part in parts if part.startswith(".")} == {".bandit"}


def test_nothing_in_it_is_a_link_or_executable(release):
    with zipfile.ZipFile(release) as archive:
        assert {entry.external_attr >> 16 for entry in archive.infolist()} == {0o100644}


def test_it_is_small_enough(release):
    assert release.stat().st_size < LIMIT


@pytest.mark.parametrize("key", REQUIRED_KEYS)
def test_the_metadata_has_every_required_key(metadata, key):
    assert metadata.get(key, "").strip()


LINKS = {
    "repository": "https://code.fleet-supervisor.invalid/plugin",
    "tracker": "https://code.fleet-supervisor.invalid/plugin/issues",
}


def test_no_address_in_it_is_made_up(metadata):
    assert not {"homepage", "repository", "tracker"} & set(metadata)
    assert "example.org" not in "".join(metadata.values())


def test_whoever_publishes_it_says_where_source_and_tracker_are(tmp_path):
    parser = ConfigParser(interpolation=None)
    with zipfile.ZipFile(build(tmp_path, LINKS)) as archive:
        parser.read_string(archive.read("fleet_supervisor/metadata.txt").decode("utf-8"))
    assert {key: parser["general"][key] for key in LINKS} == LINKS
    assert parser["general"]["name"] == "Fleet Supervisor"


@pytest.mark.parametrize("url", ["", "code", "ftp://a.b/c", "https://localhost/x", "https:///x"])
def test_what_is_no_address_is_refused(tmp_path, url):
    with pytest.raises(PackageError, match="no address of a web page"):
        build(tmp_path, {"tracker": url})
    assert list(tmp_path.iterdir()) == []


def test_the_guides_come_along_for_the_help(names):
    assert "fleet_supervisor/docs/operator.md" in names


def test_the_metadata_agrees_with_the_rest(metadata, root, names):
    project = (root / "pyproject.toml").read_text(encoding="utf-8")
    assert f'\nversion = "{metadata["version"]}"\n' in project
    assert re.fullmatch(r"\d+\.\d+\.\d+", metadata["version"])
    assert f"fleet_supervisor/{metadata['icon']}" in names
    assert metadata["hasProcessingProvider"] == "yes"


def test_the_sample_site_comes_along(names):
    site = "fleet_supervisor/resources/sample_site/"
    assert {f"{site}{name}" for name in ("site.toml", "site.gpkg", "sample_site.qgz")} <= set(names)


def test_everything_of_the_repository_that_belongs_to_the_plugin_is_in_it(root, names):
    parts = ["__init__.py", "metadata.txt", "LICENSE", "plugin", "robot_bridge", "resources"]
    parts.append("docs/*.md")
    listed = subprocess.run(
        ["git", "ls-files", *parts], cwd=root, stdout=subprocess.PIPE, text=True, check=False
    )
    if listed.returncode != 0:
        pytest.skip("this is not a git checkout")
    kept = {name for name in listed.stdout.splitlines() if (root / name).is_file()}
    makers = {name for name in kept if name.startswith("resources/") and name.endswith(".py")}
    # The gateway's service is installed from the repository, by make install-service.
    service = {name for name in kept if name.startswith("resources/service/")}
    # QGIS reads what was compiled of the translations, not their sources.
    sources = {name for name in kept if name.endswith(".ts")}
    assert {f"fleet_supervisor/{name}" for name in kept - makers - service - sources} <= set(names)


def test_what_lies_about_stays_out(root, tmp_path):
    tree = tmp_path / "tree"
    for part in ("plugin", "robot_bridge"):
        shutil.copytree(root / part, tree / part, ignore=shutil.ignore_patterns("__pycache__"))
    for part in ("__init__.py", "metadata.txt", "LICENSE", "CHANGELOG.md", ".bandit"):
        shutil.copy(root / part, tree / part)
    (tree / "resources").mkdir()
    (tree / "docs").mkdir()
    before = plugin_files(tree)
    for stray in ("plugin/notes.txt", "robot_bridge/fleet.db", "robot_bridge/x.so", "plugin/.secret.py"):
        (tree / stray).touch()
    assert plugin_files(tree) == before


@pytest.mark.parametrize(
    ("package", "module"), [("websockets", "asyncio/client.py"), ("segno", "encoder.py")]
)
def test_a_package_comes_along_as_pure_python_with_its_licence(names, package, module):
    vendor = f"fleet_supervisor/plugin/vendor/{package}/"
    assert {f"{vendor}{name}" for name in ("__init__.py", module, "LICENSE")} <= set(names)
    assert {PurePosixPath(name).suffix for name in names if name.startswith(vendor)} <= {".py", ".typed", ""}


def test_the_same_input_gives_the_same_bytes(release, tmp_path):
    assert build(tmp_path).read_bytes() == release.read_bytes()


def test_a_missing_part_is_named(tmp_path):
    with pytest.raises(PackageError, match=r"__init__\.py is missing .* restore it from git"):
        plugin_files(tmp_path)


def test_the_file_name_carries_the_version(release):
    assert release.name == f"fleet_supervisor-{version()}.zip"
