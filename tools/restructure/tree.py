"""The modules of the project as they are, and where a map of paths sends them."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from .scopes import GlobalNames, bindings

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "fleet_supervisor"
TOPS = ("plugin", "robot_bridge")


class MapError(Exception):
    """The map cannot be carried out; the text names file and line, or module."""


def dotted(path: str) -> str:
    """Return the module's name of a path from the root, such as ``plugin/desk/dock.py``."""
    name = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    return "" if name == "__init__" else name


@dataclass
class Module:
    """A Python file: ``name`` is dotted from the root, without the package's name in QGIS."""

    path: str
    text: str

    @cached_property
    def name(self) -> str:
        return dotted(self.path)

    @cached_property
    def stem(self) -> str:
        return Path(self.path).stem

    @property
    def is_package(self) -> bool:
        return self.path.endswith("__init__.py")

    @property
    def package(self) -> str:
        return self.name if self.is_package else self.name.rpartition(".")[0]

    @cached_property
    def raw(self) -> bytes:
        return self.text.encode()

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text)

    @cached_property
    def names(self) -> GlobalNames:
        return GlobalNames(self.tree)

    @cached_property
    def top(self) -> set[str]:
        return set(bindings(self.tree.body))

    @cached_property
    def line_starts(self) -> list[int]:
        starts, at = [0], 0
        for line in self.raw.splitlines(keepends=True):
            at += len(line)
            starts.append(at)
        return starts

    def offset(self, line: int, column: int) -> int:
        return self.line_starts[line - 1] + column

    def span(self, node: ast.AST) -> tuple[int, int]:
        return (
            self.offset(node.lineno, node.col_offset),  # type: ignore[attr-defined]
            self.offset(node.end_lineno, node.end_col_offset),  # type: ignore[attr-defined]
        )

    def imported_module(self, node: ast.ImportFrom) -> str | None:
        """Return the module of this project that a from-import names, or None for another's."""
        if node.level == 0:
            name = node.module or ""
            name = name.removeprefix(PACKAGE + ".") if name.startswith(PACKAGE + ".") else name
            if node.module == PACKAGE:
                return ""
            return name if name.split(".")[0] in TOPS else None
        if not (self.path == "__init__.py" or self.path.split("/")[0] in TOPS):
            return None
        parts = self.package.split(".") if self.package else []
        if node.level - 1 > len(parts):
            return None
        base = parts[: len(parts) - (node.level - 1)]
        return ".".join([*base, *([node.module] if node.module else [])])


@dataclass
class Target:
    """A module as it will be: its sources in the map's order, and its docstring if the map has one."""

    path: str
    sources: list[str] = field(default_factory=list)
    docstring: str | None = None

    @property
    def name(self) -> str:
        return dotted(self.path)

    @property
    def package(self) -> str:
        return self.name if self.path.endswith("__init__.py") else self.name.rpartition(".")[0]


@dataclass
class Plan:
    """What the maps say: targets by path, symbols renamed by (old module, name), docstrings of packages."""

    targets: dict[str, Target] = field(default_factory=dict)
    renames: dict[tuple[str, str], str] = field(default_factory=dict)
    packages: dict[str, str] = field(default_factory=dict)
    folders: dict[str, str] = field(default_factory=dict)


SOURCE = re.compile(r"\s+(\S+\.py)\s*")
TARGET = re.compile(r'(\S+\.py)\s*(?:=\s*"(.*)")?\s*')
RENAME = re.compile(r"rename\s+(\S+)\.(\w+)\s*=\s*(\w+)\s*")
FOLDER = re.compile(r"folder\s+(\S+)\s*->\s*(\S+)\s*")
DOC = re.compile(r'package\s+(\S+)\s*=\s*"(.*)"\s*')


def read_maps(files: list[Path]) -> Plan:
    """Read maps of paths.

    A line that is not indented names a module as it will be, with its docstring where it needs a new
    one; lines that are indented name what it is made of. ``rename old.module.NAME = NEW``, ``package PATH =
    "docstring"`` and
    ``folder OLD -> NEW`` (for all that no line names) stand by themselves.

    :raises MapError: for a line that is none of these.
    """
    plan = Plan()
    for file in files:
        target: Target | None = None
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            if found := RENAME.fullmatch(line):
                plan.renames[found[1], found[2]] = found[3]
            elif found := FOLDER.fullmatch(line):
                plan.folders[found[1].strip("/")] = found[2].strip("/")
            elif found := DOC.fullmatch(line):
                plan.packages[found[1].strip("/")] = found[2]
            elif found := SOURCE.fullmatch(line):
                if target is None:
                    raise MapError(f"{file}:{number}: a source before any target")
                target.sources.append(found[1])
            elif found := TARGET.fullmatch(line):
                target = plan.targets.setdefault(found[1], Target(found[1]))
                target.docstring = found[2] or target.docstring
            else:
                raise MapError(f"{file}:{number}: not understood: {line}")
    return plan


def complete(plan: Plan, modules: dict[str, Module]) -> dict[str, Target]:
    """Return all targets by path: those of the maps, and each other module at its folder's new place.

    :raises MapError: for a source that is not there or that two targets name, and for two modules at a place.
    """
    targets = {path: Target(path, list(t.sources), t.docstring) for path, t in plan.targets.items()}
    mapped: dict[str, str] = {}
    for target in targets.values():
        for source in target.sources:
            if source not in modules:
                raise MapError(f"{target.path}: there is no {source}")
            if source in mapped:
                raise MapError(f"{source} goes to {mapped[source]} and to {target.path}")
            mapped[source] = target.path
    for path, module in modules.items():
        if path in mapped or path.split("/")[0] not in TOPS:
            continue
        new = moved(path, plan.folders)
        if module.is_package and len(module.text.splitlines()) < 5:
            continue  # made anew wherever a package needs one
        if new in targets:
            raise MapError(f"{path} would come to {new}, which the map makes of {targets[new].sources}")
        targets[new] = Target(new, [path])
    return targets


def moved(path: str, folders: dict[str, str]) -> str:
    """Return a path with the longest folder that the map moves replaced."""
    parts = path.split("/")
    for count in range(len(parts), 0, -1):
        head = "/".join(parts[:count])
        if head in folders:
            return "/".join([folders[head], *parts[count:]])
    return path
