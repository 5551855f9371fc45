"""Run on the plugin's zip what plugins.qgis.org runs on it: bandit, detect-secrets and flake8, by its rules.

A finding of the first two blocks a version there. What is no fault is marked at its line, with a reason.

python -m tools.plugin_checks
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tools.package import build
from tools.plugin_files import PackageError

BANDIT = (
    "B102,B103,B104,B105,B106,B107,B108,B110,B112,B113,B201,B202,B301,B302,B303,B304,"
    "B305,B306,B307,B308,B310,B311,B312,B313,B314,B315,B316,B317,B318,B319,B321,B323,"
    "B324,B401,B402,B403,B405,B406,B407,B408,B409,B412,B413,B501,B502,B503,B504,B505,"
    "B506,B507,B508,B509,B601,B602,B603,B604,B605,B606,B607,B608,B609,B610,B611,B612,"
    "B613,B614,B615,B701,B702,B703,B704"
)
"""Its tests that are on there. B101 is left out, as publishers can: our asserts are for mypy."""
FLAKE8 = (
    "E101,E711,E712,E713,E714,E721,E722,E731,E741,E742,E743,E901,E902,E999,W605,F402,"
    "F403,F404,F405,F811,F821,F822,F823,F831,F901,C901"
)
NO_SECRETS = ("metadata.txt", ".secrets.baseline")
VENDOR = "/plugin/vendor/"


class Finding(NamedTuple):
    """What a program complains about; ``file`` is relative to the plugins folder."""

    file: str
    line: int
    rule: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.rule}"


def by_bandit(folder: Path, files: Sequence[Path] = ()) -> list[Finding]:
    """Return what bandit finds in ``folder``, or in some ``files`` of it; raises PackageError."""
    named = [str(file.relative_to(folder)) for file in files] or ["-r", "."]
    # As .bandit says, which is looked for in folders alone.
    command = ["bandit", "--quiet", "--format", "json", "-x", VENDOR, "-t", BANDIT, *named]
    report = json.loads(_run(command, folder))
    if report["errors"]:
        raise PackageError(f"bandit cannot read {report['errors']}")
    return [
        Finding(str(Path(one["filename"])), one["line_number"], f"{one['test_id']} {one['issue_text']}")
        for one in report["results"]
    ]


def by_detect_secrets(folder: Path, files: Sequence[Path] = ()) -> list[Finding]:
    """Return what detect-secrets finds in ``folder``, or in some ``files`` of it; raises PackageError."""
    command = ["detect-secrets", "scan", "--all-files", "--disable-plugin", "IPPublicDetector"]
    for name in NO_SECRETS:
        command += ["--exclude-files", name.replace(".", r"\.")]
    named = [str(file.relative_to(folder)) for file in files] or ["."]
    results = json.loads(_run([*command, *named], folder))["results"]
    return [
        Finding(file, one["line_number"], one["type"]) for file, found in results.items() for one in found
    ]


def by_flake8(folder: Path) -> list[Finding]:
    """Return what flake8 finds in ``folder``, but for what others have written; raises PackageError."""
    command = [
        "flake8",
        "--isolated",
        "--max-line-length=120",
        "--format=%(path)s\t%(row)d\t%(code)s %(text)s",
    ]
    lines = _run([*command, "--select", FLAKE8, "."], folder).splitlines()
    found = [
        Finding(str(Path(file)), int(row), rule) for file, row, rule in (line.split("\t") for line in lines)
    ]
    return [one for one in found if VENDOR not in one.file]


def _run(command: Sequence[str], folder: Path) -> str:
    program = Path(sys.executable).with_name(command[0])
    done = subprocess.run([program, *command[1:]], cwd=folder, capture_output=True, text=True, check=False)
    # 1 is for findings.
    if done.returncode not in (0, 1):
        raise PackageError(f"{command[0]} failed: {done.stderr[-2000:]}")
    return done.stdout


def main() -> int:
    with tempfile.TemporaryDirectory(prefix="plugin-checks-") as name:
        folder = Path(name) / "plugins"
        try:
            with zipfile.ZipFile(build(Path(name))) as archive:
                archive.extractall(folder)
            found = [*by_bandit(folder), *by_detect_secrets(folder), *by_flake8(folder)]
        except PackageError as error:
            print(f"plugin-checks: error: {error}", file=sys.stderr)
            return 1
    print(*found, f"{len(found)} findings", sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
