"""Which websockets package the plugin takes, in Pythons that have one, two, or none."""

from __future__ import annotations

import asyncio
import importlib.util
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from websockets.asyncio.server import serve

PLUGIN_FILES = (
    "__init__.py",
    "plugin/__init__.py",
    "plugin/ui/errors.py",
    "plugin/ui/vendored.py",
)

UNTRANSLATED = """
def tr(text, /, **values):
    return text.format(**values) if values else text
"""


@pytest.fixture
def released(tmp_path, root) -> Path:
    """A folder with the package ``fleet_supervisor``, as much of it as finds the library."""
    folder = tmp_path / "plugins" / "fleet_supervisor"
    for name in PLUGIN_FILES:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(root / name, folder / name)
    # There is no QGIS in that Python whose language could be asked.
    (folder / "plugin" / "ui" / "language.py").write_text(UNTRANSLATED, encoding="utf-8")
    return folder


def installed() -> Path:
    return Path(importlib.util.find_spec("websockets").origin).parent


def vendor(folder: Path) -> None:
    """Put websockets where the release zip has it, as pure Python."""
    target = folder / "plugin" / "vendor" / "websockets"
    shutil.copytree(installed(), target, ignore=shutil.ignore_patterns("*.so", "*.c", "__pycache__"))
    (folder / "plugin" / "vendor" / "__init__.py").touch()


def run(folder: Path, script: str, *more_paths: Path) -> str:
    """Run ``script`` in a Python that sees the standard library, the plugin and ``more_paths`` only."""
    paths = [str(folder.parent), *map(str, more_paths)]
    start = f"import sys; sys.path[:0] = {paths!r}\n"
    script = start + textwrap.dedent(script)
    done = subprocess.run(
        [sys._base_executable, "-I", "-S", "-c", script], capture_output=True, text=True, timeout=240
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


FIND = """
    from fleet_supervisor.plugin.ui.errors import LibraryMissingError
    from fleet_supervisor.plugin.ui.vendored import websocket_library
    before = list(sys.path)
    try:
        print(websocket_library().__name__)
    except LibraryMissingError as error:
        print(error)
    assert sys.path == before
"""


def test_the_plugins_own_copy_is_taken_even_where_another_is_installed(released, tmp_path):
    vendor(released)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "websockets").symlink_to(installed())
    assert run(released, FIND, tmp_path / "other") == "fleet_supervisor.plugin.vendor.websockets"


def test_without_a_copy_the_installed_one_is_taken(released, tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "websockets").symlink_to(installed())
    assert run(released, FIND, tmp_path / "other") == "websockets"


def test_without_any_the_message_says_what_to_do(released):
    said = run(released, FIND)
    assert said.startswith("The Python package websockets is missing")
    assert "release zip" in said
    assert "pip install websockets" in said


def test_one_that_is_too_old_is_named_with_its_version_and_place(released, tmp_path):
    old = tmp_path / "other" / "websockets"
    old.mkdir(parents=True)
    (old / "__init__.py").touch()
    (old / "version.py").write_text('version = "10.4"\n')
    said = run(released, FIND, tmp_path / "other")
    assert "websockets 10.4" in said
    assert str(old) in said


def test_an_empty_vendor_folder_is_no_library(released):
    (released / "plugin" / "vendor" / "websockets").mkdir(parents=True)
    assert run(released, FIND).startswith("The Python package websockets is missing")


async def test_the_plugins_own_copy_talks_to_a_real_server(released):
    vendor(released)

    async def echo(socket):
        async for text in socket:
            await socket.send(text)

    async with serve(echo, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        script = f"""
            import asyncio
            from fleet_supervisor.plugin.ui.vendored import websocket_library
            library = websocket_library()
            async def talk():
                async with library.connect("ws://127.0.0.1:{port}", proxy=None) as socket:
                    await socket.send("hello")
                    print(await socket.recv())
            asyncio.run(talk())
            assert "websockets" not in sys.modules
            assert issubclass(library.exceptions.InvalidStatus, Exception)
        """
        assert await asyncio.to_thread(run, released, script) == "hello"
