"""Run by test_qt6.py in a process of its own: which Qt names of the plugin are not there in PyQt6."""

import ast
import importlib
import sys
from pathlib import Path

# qgis.PyQt keeps these where Qt 5 had them.
_MOVED = {"QtWidgets": ("QAction", "QActionGroup", "QShortcut")}
# Methods that Qt 6 or PyQt6 no longer has.
_GONE = {"exec_", "print_", "globalPos", "toPyObject"}


def main(paths: list[str]) -> None:
    for path in map(Path, paths):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for line, text in missing(tree):
            print(f"{path}:{line}: {text}")


def missing(tree: ast.Module) -> list[tuple[int, str]]:
    """Lines and texts of what is asked of Qt and not there."""
    found = []
    names: dict[str, object] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("qgis.PyQt"):
            found += _take_in(node, names)
    outer = _outermost_attributes(tree)
    for node in outer:
        found += _resolve(node, names)
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in _GONE:
            found.append((node.lineno, f".{node.attr} is gone"))
    return found


def _take_in(node: ast.ImportFrom, names: dict[str, object]) -> list[tuple[int, str]]:
    module = (node.module or "").removeprefix("qgis.PyQt").removeprefix(".")
    found = []
    for alias in node.names:
        place = f"PyQt6.{module or alias.name}"
        if module in _MOVED and alias.name in _MOVED[module]:
            place = "PyQt6.QtGui"
        if place == "PyQt6.sip" or module == "sip":
            continue
        try:
            there = importlib.import_module(place)
            names[alias.asname or alias.name] = getattr(there, alias.name) if module else there
        except (ImportError, AttributeError):
            found.append((node.lineno, f"{place} has no {alias.name}"))
    return found


def _outermost_attributes(tree: ast.Module) -> list[ast.Attribute]:
    inner = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Attribute)
    }
    return [node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and id(node) not in inner]


def _resolve(node: ast.Attribute, names: dict[str, object]) -> list[tuple[int, str]]:
    chain = []
    base: ast.expr = node
    while isinstance(base, ast.Attribute):
        chain.insert(0, base.attr)
        base = base.value
    if not isinstance(base, ast.Name) or base.id not in names:
        return []
    thing = names[base.id]
    for attribute in chain:
        if not isinstance(thing, type) and not hasattr(thing, "__path__") and not hasattr(thing, "__file__"):
            return []  # the attribute of a value, which only a run can tell
        if not hasattr(thing, attribute):
            return [(node.lineno, f"PyQt6 has no {base.id}.{'.'.join(chain)}")]
        thing = getattr(thing, attribute)
    return []


if __name__ == "__main__":
    main(sys.argv[1:])
