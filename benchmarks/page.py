"""``docs/benchmarks.md``: one part for each thing measured, each replaced on its own."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import textwrap
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import NamedTuple

from benchmarks.clock import FEW

WIDTH = 110
_WHOLE_WORDS = {"break_long_words": False, "break_on_hyphens": False}

HEAD = f"""\
# Benchmarks

Each part is made by the command that it names. Times are medians on the machine as it was; the ratios are
what to compare. In square brackets behind a median: its quartiles, of fewer than {FEW} runs the least and the
most. A goal is *met* or **missed**. A part names the commit whose code it measured; one that names none is
older than that, and than the code that it lies beside.
"""
TELLING = (
    *("MALLOC_", "LD_PRELOAD", "OMP_", "OPENBLAS_", "MKL_", "UV_", "QT_", "PEER", "MINUTES", "DRIVES"),
    *(
        "GDAL_CACHEMAX",
        "GDAL_NUM_THREADS",
        "PYTHONMALLOC",
        "PYTHONHASHSEED",
        "PYTHONOPTIMIZE",
        "PYTHONDEVMODE",
    ),
)
"""How the names of the environment's variables begin that may change a figure."""

PAGE = Path(__file__).resolve().parents[1] / "docs" / "benchmarks.md"
BENCH = [
    "maps",
    "big_site",
    "load",
    "links",
    "link_memory",
    "round_trip",
    "faults",
    "attack",
    "roads",
    "surfaces",
    "publishing",
    "localisation",
    "filter_update",
    "assignment",
    "desk",
    "field_page",
    "fleet_views",
    "appliance",
    "full_disk",
    "cluster",
    "cluster_positions",
    "cluster_views",
    "cluster_kills",
    "before",
    "endurance",
]
"""What ``make bench`` measures: modules of benchmarks; each has ``measure(data)``."""
MUTANTS = "mutants"
ORDER = [*BENCH, MUTANTS]
"""The parts of the page."""


@dataclass(frozen=True)
class Part:
    """What was measured of one thing: a heading, Markdown below it, and whether something was wrong."""

    heading: str
    text: str
    failed: bool = False
    command: str = ""
    """what makes it, ``make bench`` by default."""
    settings: Mapping[str, str] = field(default_factory=dict)
    """variables of the environment that the part sets for programs that it starts."""


class Beginning(NamedTuple):
    """When a part began, by this process's clock, and the load of the machine in the last minute."""

    at: float
    load: float

    @classmethod
    def now(cls) -> Beginning:
        """Return what is so now."""
        return cls(time.monotonic(), os.getloadavg()[0])


def goal(text: str, is_met: bool) -> str:
    """Return a goal and whether it is met, as each part states it."""
    return f"goal: {text}, {'met' if is_met else '**missed**'}"


def write_part(name: str, part: Part, began: Beginning | None = None) -> None:
    """Put part ``name`` into the page, in place of what it said before."""
    page = PAGE.read_text(encoding="utf-8") if PAGE.is_file() else ""
    PAGE.write_text(with_part(page, name, part, ORDER, began), encoding="utf-8")


def with_part(page: str, name: str, part: Part, order: list[str], began: Beginning | None = None) -> str:
    """Return ``page`` with part ``name`` new or replaced; parts stand in ``order``."""
    parts = dict(re.findall(r"<!-- (\w+) -->\n(.*?)\n<!-- end -->", page, re.DOTALL))
    made_by = _made_by(part.command or f"make bench PARTS={name}")
    conditions = " ".join([made_by, *([_beside(began)] if began else []), _environment(part.settings)])
    parts[name] = f"## {part.heading}\n\n{_wrapped(conditions)}\n\n{_wrapped(part.text.strip())}"
    told = [f"<!-- {name} -->\n{parts[name]}\n<!-- end -->\n" for name in order if name in parts]
    return "\n".join([HEAD, *told])


def _wrapped(text: str) -> str:
    """Return Markdown with its paragraphs wrapped anew: what was put into them has a length of its own."""
    return "\n\n".join(
        block if block.startswith(("|", "#", "-", " ")) else textwrap.fill(block, WIDTH, **_WHOLE_WORDS)
        for block in re.split(r"\n{2,}", text)
    )


def _made_by(command: str) -> str:
    machine = f"{os.cpu_count()} cores, {platform.machine()}, {platform.system()}"
    return (
        f"Made by `{command}`{_of_commit()}, on {machine}, Python {platform.python_version()}, "
        f"on {date.today().isoformat()}."
    )


def _of_commit() -> str:
    """Return which code is measured, nothing where git does not know.

    The page itself does not count: the parts of one run write it one after the other.
    """
    page = PAGE.relative_to(PAGE.parents[1])
    try:
        name = _git("describe", "--always", "--abbrev=8", "--exclude=*")
        changed = _git("status", "--porcelain", "--untracked-files=no", "--", ":/", f":(top,exclude){page}")
    except (OSError, subprocess.CalledProcessError):
        return ""
    return f" of commit {name}{' with changes' if changed else ''}"


def _git(*words: str) -> str:
    git = ["git", "-C", str(PAGE.parents[1]), *words]
    return subprocess.run(git, capture_output=True, text=True, check=True).stdout.strip()


def _beside(began: Beginning) -> str:
    """Return how long it took, and what else the machine had to do."""
    minutes = (time.monotonic() - began.at) / 60
    return (
        f"It took {minutes:.1f} minutes at nice {os.nice(0)}; load of the machine in the minute before it "
        f"began {began.load:.1f}, in the last one {os.getloadavg()[0]:.1f}, the part itself included."
    )


def _environment(settings: Mapping[str, str]) -> str:
    """Return what of the environment may matter: what was there, and what the part set."""
    given = {name: value for name, value in os.environ.items() if value and name.startswith(TELLING)}
    found = given | dict(settings)
    told = ", ".join(f"`{name}={value}`" for name, value in sorted(found.items()))
    return f"Environment: {told or 'nothing that matters'}."
