"""Build the guides as a site, build/site; without any warning, or not at all.

python -m tools.documentation [--output FOLDER]
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tools.plugin_files import ROOT

SOURCES = ROOT / "build" / "site-sources"
PARTS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "docs")
API = ROOT / "docs" / "api.md"
API_SOURCES = ROOT / "build" / "api-sources"


def lay_out(folder: Path = SOURCES) -> None:
    """Show the guides in ``folder`` as they lie in the repository, and nothing else of it."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in PARTS:
        link = folder / name
        link.unlink(missing_ok=True)
        link.symlink_to(ROOT / name)


def lay_out_api(folder: Path = API_SOURCES) -> None:
    """Show in ``folder`` those packages of the gateway that the page of the API is about.

    What is shown is read whole, and most of the gateway is no part of its API.
    """
    shutil.rmtree(folder, ignore_errors=True)
    named = re.findall(r"^::: (\w+)\.(\w+)", API.read_text(encoding="utf-8"), re.MULTILINE)
    for package, part in sorted(set(named)):
        (folder / package).mkdir(parents=True, exist_ok=True)
        for source in (ROOT / package / "__init__.py", ROOT / package / part):
            link = folder / package / source.name
            if not link.exists():
                link.symlink_to(source)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=ROOT / "build" / "site")
    output = parser.parse_args().output.resolve()
    lay_out()
    lay_out_api()
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", output]
    # The theme's makers advertise on each run otherwise.
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, check=False)
    if done.returncode == 0:
        print(f"{output / 'index.html'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
