"""Build the gateway's sdist and wheel, build/fleet_supervisor_robot_bridge-VERSION*.

They need no repository: pip installs either, and who has the sdist can make the wheel, as is done here. The
same input gives the same wheel.

python -m tools.gateway_package [--output FOLDER]
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from tools.plugin_files import ROOT, PackageError, belongs

FILES = ("pyproject.toml", "README.md", "LICENSE")
PART = "robot_bridge"
EPOCH = 315_532_800
"""1980, the oldest time that a wheel can hold, so that the day of building leaves no trace."""


class GatewayPackage(NamedTuple):
    """What was built."""

    sdist: Path
    wheel: Path


def build(folder: Path, root: Path = ROOT) -> GatewayPackage:
    """Build the sdist, and the wheel of that sdist, into ``folder``.

    :raises PackageError: when a part is missing, or the build fails.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="gateway-package-") as name:
        # Not in the tree itself: setuptools leaves copies behind there, which the next wheel would hold too.
        sources = Path(name) / "sources"
        for file in gateway_files(root):
            copy = sources / file.relative_to(root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
        sdist = _made("build_sdist", sources, folder)
        shutil.unpack_archive(sdist, name)
        wheel = _made("build_wheel", Path(name) / sdist.name.removesuffix(".tar.gz"), folder)
    return GatewayPackage(sdist, wheel)


def gateway_files(root: Path = ROOT) -> list[Path]:
    """Return every file that the gateway is built of, in a fixed order.

    :raises PackageError: when a part is missing.
    """
    named = [root / name for name in FILES]
    for file in (*named, root / PART):
        if not file.exists():
            raise PackageError(f"{file} is missing and belongs to the gateway; restore it from git")
    parts = (file for file in (root / PART).rglob("*") if file.is_file() and belongs(file, root))
    return sorted([*named, *parts])


def _made(step: str, sources: Path, folder: Path) -> Path:
    """Do a step of the build backend that pyproject.toml names; return what it made in ``folder``."""
    code = f"import sys; from setuptools import build_meta; print(build_meta.{step}(sys.argv[1]))"
    done = subprocess.run(
        [sys.executable, "-c", code, folder.resolve()],
        cwd=sources,
        env={**os.environ, "SOURCE_DATE_EPOCH": str(EPOCH)},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise PackageError(f"{step} of setuptools failed; its last words:\n{done.stderr[-2000:]}")
    return folder / done.stdout.splitlines()[-1]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "build")
    try:
        package = build(parser.parse_args().output)
    except PackageError as error:
        print(f"gateway-package: error: {error}", file=sys.stderr)
        return 1
    for file in package:
        print(f"{file} ({file.stat().st_size / 1e6:.2f} MB)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
