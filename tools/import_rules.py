"""Check who imports whom (the contracts of pyproject.toml, by import-linter); ends with its exit status.

import-linter finds packages by name on ``sys.path``, and the repository's root is a package only under the
name that QGIS gives it. So it gets a folder that holds nothing but a link of that name.

    python -m tools.import_rules [ROOT]
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGE = "fleet_supervisor"


def check(root: Path, *, quiet: bool = False) -> subprocess.CompletedProcess[str]:
    """Run import-linter on the tree at ``root`` with the contracts of its pyproject.toml."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / PACKAGE).symlink_to(root, target_is_directory=True)
        return subprocess.run(
            [
                Path(sys.executable).with_name("lint-imports"),
                "--no-cache",
                "--no-logo",
                "--config",
                root / "pyproject.toml",
            ],
            env={**os.environ, "PYTHONPATH": place, "NO_COLOR": "1"},
            cwd=place,
            capture_output=quiet,
            text=True,
            check=False,
        )


if __name__ == "__main__":
    tree = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1]
    sys.exit(check(tree.resolve()).returncode)
