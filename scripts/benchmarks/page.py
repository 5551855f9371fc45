"""``docs/benchmarks.md``: one part for each thing measured, each replaced on its own."""

from __future__ import annotations

import os
import platform
import re
from dataclasses import dataclass
from datetime import date

HEAD = """\
# Benchmarks

Each part is made by the command that it names. Times are medians on the machine as it was; the ratios are
what to compare.
"""


@dataclass(frozen=True)
class Part:
    """What was measured of one thing: a heading, Markdown below it, and whether something was wrong."""

    heading: str
    text: str
    failed: bool = False


def with_part(page: str, name: str, part: Part, order: list[str]) -> str:
    """Return ``page`` with part ``name`` new or replaced; parts stand in ``order``."""
    parts = dict(re.findall(r"<!-- (\w+) -->\n(.*?)\n<!-- end -->", page, re.DOTALL))
    parts[name] = f"## {part.heading}\n\n{_made_by(name)}\n\n{part.text.strip()}"
    told = [f"<!-- {name} -->\n{parts[name]}\n<!-- end -->\n" for name in order if name in parts]
    return "\n".join([HEAD, *told])


def _made_by(name: str) -> str:
    machine = f"{os.cpu_count()} cores, {platform.machine()}, {platform.system()}"
    return (
        f"Made by `make bench PARTS={name}`, on {machine}, Python {platform.python_version()}, "
        f"on {date.today().isoformat()}."
    )
