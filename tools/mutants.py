"""Try what stops robots with mutants: ``mutants.py [--again | --report] [name ...]``.

All together are written to docs/benchmarks.md. A name is part of a module's path, such as ``emergency``: then
only that is tried. With ``--again`` only those are tried that lived the last time, and functions that have
changed; ``--report`` tries nothing and writes what was found, also by a run that was stopped. What is tried,
and with which tests, says [tool.mutmut] in pyproject.toml; what may live, and why,
tools/mutation/survivors.toml.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.page import MUTANTS, write_part
from tools.mutation.findings import Fate, Mutant, read_findings
from tools.mutation.reasons import ReasonError, Reasons
from tools.mutation.report import DIED, part_of
from tools.mutation.tree import copy_tree, mutated_files
from tools.plugin_files import ROOT

TREE = ROOT / "build" / "mutation"
AGAIN, REPORT = "--again", "--report"
MEMORY = Path("/dev/shm")
"""A folder that no disk holds up, where the system has one: the tests make databases."""


def main() -> int:
    """Try mutants and say what lives; return 1 where something lives without a reason, or too few died."""
    names = [word for word in sys.argv[1:] if word not in (AGAIN, REPORT)]
    try:
        reasons = Reasons()
        if REPORT not in sys.argv[1:]:
            _try_mutants(names)
        mutants = [one for one in read_findings(TREE) if one.fate is not Fate.UNTRIED or not names]
        if not names:
            reasons.check(mutants)
    except ReasonError as error:
        sys.exit(f"mutants: {error}")
    part = part_of(mutants, reasons)
    if not names:
        write_part(MUTANTS, part)
    print(f"## {part.heading}\n\n{part.text}")
    return int(part.failed or any(_lives_unexplained(one, reasons) for one in mutants))


def _try_mutants(names: list[str]) -> None:
    copy_tree(ROOT, TREE, again=AGAIN in sys.argv[1:])
    wanted = [_pattern(path) for path in mutated_files(TREE) if any(name in str(path) for name in names)]
    if names and not wanted:
        sys.exit(f"mutants: no module that is mutated has {' or '.join(names)} in its path")
    with tempfile.TemporaryDirectory(dir=MEMORY if MEMORY.is_dir() else None) as folder:
        # mypy, which mutmut asks first, is the environment's own.
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment = {**os.environ, "PATH": path, "PYTEST_DEBUG_TEMPROOT": folder}
        done = subprocess.run(["mutmut", "run", *wanted], cwd=TREE, env=environment, check=False)
    if done.returncode:
        sys.exit(f"mutants: mutmut ended with status {done.returncode}")


def _pattern(module: Path) -> str:
    return ".".join(module.relative_to(TREE).with_suffix("").parts) + ".*"


def _lives_unexplained(mutant: Mutant, reasons: Reasons) -> bool:
    return mutant.fate not in DIED and reasons.of(mutant) is None


if __name__ == "__main__":
    sys.exit(main())
