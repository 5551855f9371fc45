"""What mutmut found: each mutant, what it changes, and whether a test or mypy noticed that."""

from __future__ import annotations

import ast
import difflib
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from tools.mutation.tree import PROPERTY, mutated_files

_NAME = re.compile(r"x(?:_|ǁ(?P<cls>\w+)ǁ)(?P<function>\w+?)__mutmut_(?:(?P<number>\d+)|orig)$")


class Fate(Enum):
    """What became of a mutant."""

    TYPES = "refused by mypy"
    KILLED = "a test failed"
    TIMED_OUT = "a test came to no end"
    SURVIVED = "every test passed"
    UNREACHED = "no test runs that"
    UNTRIED = "not tried"


_FATES = {None: Fate.UNTRIED, 0: Fate.SURVIVED, 1: Fate.KILLED, 3: Fate.KILLED, 37: Fate.TYPES}
_FATES |= {33: Fate.UNREACHED, 5: Fate.UNREACHED}
_FATES |= dict.fromkeys((-24, 24, 36, 152, 255, -9), Fate.TIMED_OUT)


@dataclass(frozen=True)
class Mutant:
    """One change of one function, as ``was`` and ``becomes`` say in the spelling of ast.unparse."""

    module: str
    function: str
    was: str
    becomes: str
    fate: Fate
    name: str

    @property
    def change(self) -> tuple[str, str, str, str]:
        """What identifies it as long as its function reads as it does."""
        return self.module, self.function, self.was, self.becomes


def read_findings(tree: Path) -> list[Mutant]:
    """Return every mutant of the copy ``tree``, by module and in the order of the code."""
    return [mutant for path in mutated_files(tree) for mutant in _of_module(tree, path.relative_to(tree))]


def _of_module(tree: Path, module: Path) -> Iterator[Mutant]:
    report = tree / "mutants" / f"{module}.meta"
    codes: dict[str, int | None] = {}
    if report.is_file():
        codes = json.loads(report.read_text(encoding="utf-8"))["exit_code_by_key"]
    functions = _functions((tree / "mutants" / module).read_text(encoding="utf-8")) if codes else {}
    for name, code in codes.items():
        mangled = name.rpartition(".")[2]
        match = _NAME.match(mangled)
        assert match is not None, name
        original = functions[f"{mangled.rpartition('__mutmut_')[0]}__mutmut_orig"]
        was, becomes = _difference(original, functions[mangled])
        function = ".".join(filter(None, (match["cls"], match["function"].removeprefix(PROPERTY))))
        yield Mutant(str(module), function, was, becomes, _FATES.get(code, Fate.KILLED), name)


def _functions(source: str) -> dict[str, list[str]]:
    """Return the lines of every function that mutmut wrote, without its head's name."""
    found = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and "__mutmut_" in node.name:
            name, node.name = node.name, "f"
            found[name] = ast.unparse(node).splitlines()
    return found


def _difference(original: list[str], mutated: list[str]) -> tuple[str, str]:
    lines = list(difflib.ndiff(original, mutated))
    was = [line[2:].strip() for line in lines if line.startswith("- ")]
    becomes = [line[2:].strip() for line in lines if line.startswith("+ ")]
    return " / ".join(was), " / ".join(becomes)
