"""Hook of mkdocs: what GitHub's Markdown has and Python's has not, said in Python's."""

from __future__ import annotations

import re
from typing import Any

FENCE = re.compile(r"^(\s*```+)(\w*).*$")
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.) ")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Return a page as Python's Markdown wants it.

    A fence has one word, which is its language, and a list begins behind an empty line.
    """
    lines: list[str] = []
    is_code = False
    for line in markdown.splitlines():
        if fence := FENCE.match(line):
            is_code = not is_code
            line = fence.group(1) + fence.group(2)
        elif not is_code and ITEM.match(line) and lines and _is_paragraph(lines):
            lines.append("")
        lines.append(line)
    return "\n".join(lines) + "\n"


def _is_paragraph(lines: list[str]) -> bool:
    """Whether the last of ``lines`` are text that is in no list."""
    for line in reversed(lines):
        if not line.strip():
            return lines[-1] != line
        if ITEM.match(line) or line.startswith(("#", "|", "<", " ")):
            return False
    return True
