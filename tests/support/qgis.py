"""QGIS with the plugin in a profile of its own, so that the user's profile stays as it is."""

from __future__ import annotations

import os
import shutil
import sys
import sysconfig
from importlib.util import cache_from_source
from pathlib import Path

from tests.support.errors import StageError
from tests.support.processes import Processes
from tools.install_plugin import install
from tools.plugin_files import ROOT

SETTINGS = """\
[PythonPlugins]
fleet_supervisor=true
processing=true
MetaSearch=false
db_manager=false
grassprovider=false
otbprovider=false
sagaprovider=false

[app]
projections\\unknownCrsBehavior=NoAction

[qgis]
checkVersion=false
askToSaveProjectChanges=false
warnOldProjectVersion=false
networkAndProxy\\networkTimeout=1000

[fonts]
downloadMissingFonts=false

[auth]
use_password_helper=false

[UI]
Customization\\enabled=false
"""


GREETED = """
[fleet_supervisor]
tour_offered=true
"""


class Profile:
    """A QGIS configuration folder with nothing in it but the plugin, made anew.

    :param link: link the repository instead of copying the plugin as a release holds it.
    :param greeted: the plugin has offered its tour already, as it does once in a profile.
    :param theme: how QGIS looks, empty for the usual way.
    """

    def __init__(self, folder: Path, *, link: bool, greeted: bool = True, theme: str = ""):
        self._folder = folder
        shutil.rmtree(folder, ignore_errors=True)
        profile = folder / "profiles" / "default"
        (profile / "QGIS").mkdir(parents=True)
        settings = SETTINGS + (f"UITheme={theme}\n" if theme else "") + (GREETED if greeted else "")
        (profile / "QGIS" / "QGIS3.ini").write_text(settings, encoding="utf-8")
        (folder / "run").mkdir(mode=0o700)
        self.plugin = install(profile, link=link)
        if not link:
            add_compiled(self.plugin)

    def environment(self, *, packages: bool) -> dict[str, str]:
        """Return what QGIS's environment needs; with ``packages`` it also sees those of this environment."""
        paths = [str(ROOT)]
        if packages:
            paths.append(sysconfig.get_path("purelib"))
        return {
            "QGIS_CUSTOM_CONFIG_PATH": str(self._folder),
            "XDG_RUNTIME_DIR": str(self._folder / "run"),
            "PYTHONPATH": os.pathsep.join(paths),
            # A QGIS that ends abruptly says what its Python was at.
            "PYTHONFAULTHANDLER": "1",
        }


def add_compiled(plugin: Path) -> None:
    """Put what Python has compiled of the repository beside the copy, so that QGIS need not."""
    for copy in plugin.rglob("*.py"):
        source = ROOT / copy.relative_to(plugin)
        compiled = Path(cache_from_source(str(source)))
        if compiled.is_file() and copy.read_bytes() == source.read_bytes():
            # Compiled is what is as old as its source.
            os.utime(copy, ns=(source.stat().st_atime_ns, source.stat().st_mtime_ns))
            target = Path(cache_from_source(str(copy)))
            target.parent.mkdir(exist_ok=True)
            shutil.copy(compiled, target)


def program(name: str) -> str:
    """Return the path of ``qgis`` or ``qgis_process``.

    On Debian the program itself has the suffix ``.bin``; the script before it is broken there.

    :raises StageError: when it is not on the path.
    """
    found = shutil.which(f"{name}.bin") or shutil.which(name)
    if found is None:
        raise StageError(f"{name} is not on the path; run: make setup")
    return found


def virtual_screen(processes: Processes, width: int, height: int) -> str:
    """Start an X server without a screen and return its display name.

    :raises StageError: when Xvfb is missing or does not start.
    """
    if shutil.which("Xvfb") is None:
        raise StageError("there is no display and no Xvfb to make one; run: make setup")
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"]
    processes.start("xvfb", command)
    return ":" + processes.wait_for_line("xvfb", r"(?m)^(\d+)$", 10).group(1)


def has_screen() -> bool:
    """Whether a window can be opened for the user."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
