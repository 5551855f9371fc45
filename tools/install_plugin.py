"""Put the plugin into a QGIS profile of this user.

python -m tools.install_plugin [--profile NAME] [--link]
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from pathlib import Path

from tools.plugin_files import PACKAGE, ROOT, PackageError, plugin_files, version


class InstallError(Exception):
    """The plugin cannot be put there; the text says why and what to do."""


def profiles_folder(environment: dict[str, str], platform: str) -> Path:
    """Return where QGIS 3 keeps its profiles on ``platform`` (as in ``sys.platform``)."""
    if custom := environment.get("QGIS_CUSTOM_CONFIG_PATH"):
        return Path(custom) / "profiles"
    home = Path(environment.get("HOME") or Path.home())
    if platform == "win32":
        data = Path(environment["APPDATA"])
    elif platform == "darwin":
        data = home / "Library" / "Application Support"
    else:
        data = Path(environment.get("XDG_DATA_HOME") or home / ".local" / "share")
    return data / "QGIS" / "QGIS3" / "profiles"


def install(profile: Path, *, link: bool) -> Path:
    """Copy the plugin into ``profile``, or link this folder there; return its place.

    What stood there is replaced in one step and only if it is this plugin.

    :raises InstallError: when something else stands there.
    """
    plugins = profile / "python" / "plugins"
    target = plugins / PACKAGE
    check_replaceable(target)
    plugins.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=plugins, prefix=f".{PACKAGE}-") as place:
        fresh = Path(place) / "fresh"
        if link:
            fresh.symlink_to(ROOT, target_is_directory=True)
        else:
            write_copy(fresh)
        if target.is_symlink() or target.exists():
            target.rename(Path(place) / "former")
        fresh.rename(target)
    return target


def check_replaceable(target: Path) -> None:
    """Raise InstallError when ``target`` is there and is not this plugin."""
    if not target.exists() or target.is_symlink():
        return
    metadata = target / "metadata.txt"
    lines = metadata.read_text(encoding="utf-8").splitlines() if metadata.is_file() else []
    if "name=Fleet Supervisor" not in lines:
        raise InstallError(f"{target} is there and is not this plugin; move it away and install again")


def write_copy(folder: Path) -> None:
    """Write every file of the plugin below ``folder``."""
    for name, content in plugin_files().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--profile", default="default", help="the QGIS profile's name (default: default)")
    parser.add_argument("--link", action="store_true", help="link this folder instead of copying it")
    arguments = parser.parse_args()
    profile = profiles_folder(dict(os.environ), sys.platform) / arguments.profile
    is_new = not profile.is_dir()
    try:
        target = install(profile, link=arguments.link)
    except (InstallError, PackageError, OSError, shutil.Error) as error:
        print(f"install: error: {error}", file=sys.stderr)
        return 1
    print(f"Fleet Supervisor {version()} is in {target}")
    if is_new:
        print(f"The profile is new; start QGIS with: qgis --profile {arguments.profile}")
    if arguments.link:
        print("A linked plugin has no packages: QGIS's Python must have them (pip install websockets segno).")
    print("In QGIS: Plugins > Manage and Install Plugins > Installed > tick Fleet Supervisor.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
