"""Measure on the real data and write docs/benchmarks.md: ``python -m benchmarks [part ...]``."""

from __future__ import annotations

import importlib
import subprocess
import sys

from benchmarks.page import BENCH, Beginning, Part, write_part
from benchmarks.trial import IS_TRIAL
from tests.support.processes import dying_with_this, leave_on_signals
from tools.plugin_files import ROOT

DATA = ROOT.parent / "shared" / "data"


def main() -> int:
    """Measure the parts that are asked for, all by default; return 1 if one of them found something wrong."""
    if not DATA.is_dir():
        sys.exit(f"bench: the real data is not on this machine: {DATA} does not exist")
    wanted = sys.argv[1:] or BENCH
    unknown = sorted(set(wanted) - set(BENCH))
    if unknown:
        sys.exit(f"bench: there is no part {', '.join(unknown)}; choose from {', '.join(BENCH)}")
    leave_on_signals()
    if len(wanted) == 1:
        return int(_measure(wanted[0]).failed)
    # A process each: Linux counts the memory of whoever starts a program as that program's.
    return max(
        subprocess.run(dying_with_this([sys.executable, "-m", "benchmarks", name]), check=False).returncode
        for name in wanted
    )


def _measure(name: str) -> Part:
    began = Beginning.now()
    part: Part = importlib.import_module(f"benchmarks.{name}").measure(DATA)
    if not IS_TRIAL:
        write_part(name, part, began)
    print(f"## {part.heading}\n\n{part.text}")
    return part


if __name__ == "__main__":
    sys.exit(main())
