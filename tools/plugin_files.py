"""What of the repository makes up the plugin, and the packages that go with it."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import sys
from collections.abc import Iterator
from configparser import ConfigParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = "fleet_supervisor"
FILES = ("__init__.py", "metadata.txt", "LICENSE", "CHANGELOG.md", ".bandit")
PARTS = (*FILES, "plugin", "robot_bridge", "resources", "docs")
VENDORED = ("segno", "websockets")
"""Pure Python, so that a stock QGIS needs nothing more."""
VENDOR = Path("plugin") / "vendor"
VENDOR_NOTE = '"""Packages that come with the release, unchanged; each holds its own licence."""\n'

KINDS = {
    "plugin": {".py"},
    "robot_bridge": {".css", ".html", ".js", ".py", ".svg", ".toml", ".txt"},
    "docs": {".md"},
    "resources": {".gpkg", ".png", ".qgz", ".qm", ".qml", ".svg", ".tif", ".toml"},
}
"""What each part holds, by suffix; whatever else lies there (caches, backups, makers of resources) stays."""

LEFT_OUT_FOLDERS = {"__pycache__", "vendor"}


class PackageError(Exception):
    """The plugin cannot be packed; the text says what is missing and what to do."""


def version(root: Path = ROOT) -> str:
    """Return the version of ``metadata.txt``."""
    metadata = ConfigParser(interpolation=None)
    metadata.read(root / "metadata.txt", encoding="utf-8")
    return metadata["general"]["version"]


def plugin_files(root: Path = ROOT) -> dict[str, bytes]:
    """Return every file of the plugin, by its path below the plugin's folder, in a fixed order.

    :raises PackageError: when a part is missing or a package is not there to take along.
    """
    files = {path.relative_to(root).as_posix(): path.read_bytes() for path in _own_files(root)}
    files |= {f"{VENDOR.as_posix()}/{name}": content for name, content in _vendored_files()}
    return dict(sorted(files.items()))


def _own_files(root: Path) -> Iterator[Path]:
    for part in PARTS:
        path = root / part
        if path.is_file():
            yield path
        elif path.is_dir():
            yield from (file for file in path.rglob("*") if file.is_file() and belongs(file, root))
        else:
            raise PackageError(f"{path} is missing and belongs to the plugin; restore it from git")


def belongs(file: Path, root: Path) -> bool:
    """Whether ``file``, in a folder of :data:`KINDS` below ``root``, is part of it and not just there."""
    path = file.relative_to(root)
    hidden = any(part.startswith(".") for part in path.parts)
    return not hidden and not LEFT_OUT_FOLDERS & set(path.parts) and path.suffix in KINDS[path.parts[0]]


def _vendored_files() -> Iterator[tuple[str, bytes]]:
    yield "__init__.py", VENDOR_NOTE.encode()
    for package in VENDORED:
        yield from _files_of(package)


def _files_of(package: str) -> Iterator[tuple[str, bytes]]:
    try:
        distribution = importlib.metadata.distribution(package)
    except importlib.metadata.PackageNotFoundError:
        raise PackageError(f"{package} is not installed beside {__file__}; run: make setup") from None
    licences = 0
    for entry in distribution.files or ():
        source = Path(str(distribution.locate_file(entry)))
        if entry.parts[0] == package and (entry.suffix == ".py" or entry.name == "py.typed"):
            yield entry.as_posix(), source.read_bytes()
        elif entry.name.upper().startswith("LICEN"):
            licences += 1
            yield f"{package}/LICENSE", source.read_bytes()
    if licences != 1:
        raise PackageError(
            f"{package} {distribution.version} has {licences} licence files where one is expected; "
            f"install it from its wheel: .venv/bin/python -m pip install --force-reinstall {package}"
        )


def register_plugin() -> None:
    """Make the repository's root importable under the name that QGIS gives it."""
    if PACKAGE in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE])
