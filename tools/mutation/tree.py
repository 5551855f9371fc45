"""The copy of the repository in which mutmut works: what it mutates, what the tests need, no more."""

from __future__ import annotations

import ast
import json
import shutil
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import tomllib

PARTS = (
    "robot_bridge",
    "benchmarks",
    "tools",
    "tests/support",
    "tests/robot_bridge",
    "tests/conftest.py",
    "__init__.py",
    "pyproject.toml",
)
PARTS += ("resources/sample_site",)
DEAD = (1, 3, 37)
"""mutmut's numbers for mutants that a test or mypy refused."""
PROPERTY = "property_"
"""Begins the name of the method that a property of the copy calls."""


def copy_tree(root: Path, tree: Path, *, again: bool = False) -> None:
    """Make ``tree`` a new copy of ``root``, in which properties are mutated like all other methods.

    With ``again`` mutants of the copy before that died stay dead, where their function is as it was.
    """
    results = _results(tree) if again else {}
    shutil.rmtree(tree, ignore_errors=True)
    for path, result in results.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(result), encoding="utf-8")
    for part in PARTS:
        source, target = root / part, tree / part
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, target)
    for path in mutated_files(tree):
        path.write_text(with_methods_for_properties(path.read_text(encoding="utf-8")), encoding="utf-8")


def _results(tree: Path) -> dict[Path, dict[str, Any]]:
    """Return what mutmut keeps of each module, with everything that lived to be tried once more."""
    results = {}
    for path in (tree / "mutants").rglob("*.py.meta"):
        result = json.loads(path.read_text(encoding="utf-8"))
        codes = result["exit_code_by_key"]
        result["exit_code_by_key"] = {name: code if code in DEAD else None for name, code in codes.items()}
        results[path] = result
    return results


def mutated_files(tree: Path) -> list[Path]:
    """Return the files that pyproject.toml names as those to mutate."""
    settings = tomllib.loads((tree / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["mutmut"]
    files = sorted((tree / "robot_bridge").rglob("*.py"))
    return [
        path
        for path in files
        if any(fnmatch(str(path.relative_to(tree)), pattern) for pattern in settings["only_mutate"])
    ]


def with_methods_for_properties(source: str) -> str:
    """Return ``source`` with the body of each property in a method that the property calls.

    mutmut passes over everything with a decorator, and what a robot is allowed often stands in a property.
    """
    lines = source.splitlines(keepends=True)
    for cls in [node for node in ast.parse(source).body if isinstance(node, ast.ClassDef)][::-1]:
        for method in [node for node in cls.body if isinstance(node, ast.FunctionDef)][::-1]:
            if [ast.unparse(decorator) for decorator in method.decorator_list] == ["property"]:
                _move_body(lines, method)
    return "".join(lines)


def _move_body(lines: list[str], method: ast.FunctionDef) -> None:
    first, end = method.lineno - 1, method.end_lineno
    assert end is not None
    head = lines[first]
    lines[end:end] = ["\n", "    @property\n", head, f"        return self.{PROPERTY}{method.name}()\n"]
    lines[first] = head.replace(f"def {method.name}", f"def {PROPERTY}{method.name}", 1)
    del lines[method.decorator_list[0].lineno - 1]
