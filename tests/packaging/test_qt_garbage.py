"""No function that is connected to a signal is all that keeps the signal's object alive in Python.

Python knows that an object holds what is connected to its signals. Where that function holds the object in
turn, and nothing else in Python does, Python takes both for garbage, though Qt still has the object: the next
signal calls a function that is gone, and QGIS crashes. What is made by its class stays while Qt has it; what
Qt hands out (``table.horizontalHeader()``) does not, and nor does a task, which QGIS lets go of when it has
ended. So only what is made in the same function, and is no task, may be held.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

import pytest

from tools.syntax import tree_of


def held_by_their_own_signals(code: str) -> list[tuple[int, str]]:
    """The lines and names of objects that may be garbage together with what is connected to them."""
    found = set()
    for node in ast.walk(tree_of(code)):
        if isinstance(node, ast.FunctionDef | ast.Lambda):
            found |= set(_held_in(node))
    return sorted(found)


def _held_in(function: ast.FunctionDef | ast.Lambda) -> Iterator[tuple[int, str]]:
    made = set(_made_by_their_class(function))
    inner = {node.name: node for node in ast.walk(function) if isinstance(node, ast.FunctionDef)}
    for call in ast.walk(function):
        if not (
            isinstance(call, ast.Call)
            and isinstance(call.func, ast.Attribute)
            and call.func.attr == "connect"
        ):
            continue
        sender = _first_name(call.func.value)
        for slot in call.args:
            slot = inner.get(slot.id, slot) if isinstance(slot, ast.Name) else slot
            closes_over = isinstance(slot, ast.Lambda | ast.FunctionDef | ast.Call)
            if closes_over and sender not in made | {"self"} and sender in _names(slot):
                yield call.lineno, sender


def _made_by_their_class(function: ast.AST) -> Iterator[str]:
    for node in ast.walk(function):
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call):
            name = node.value.func
            if isinstance(name, ast.Name) and name.id[0].isupper() and not name.id.endswith("Task"):
                yield from (target.id for target in node.targets if isinstance(target, ast.Name))


def _first_name(node: ast.AST) -> str:
    while isinstance(node, ast.Attribute | ast.Call | ast.Subscript):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.id if isinstance(node, ast.Name) else ""


def _names(node: ast.AST) -> set[str]:
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}


def test_nothing_in_the_plugin_is_kept_alive_by_its_own_signals_only(root):
    paths = [
        path
        for part in ("plugin", "benchmarks", "tests/support", "tools")
        for path in sorted((root / part).rglob("*.py"))
    ]
    found = {str(path): held_by_their_own_signals(path.read_text(encoding="utf-8")) for path in paths}
    assert len(found) > 100
    assert {path: held for path, held in found.items() if held} == {}


@pytest.mark.parametrize(
    "code",
    [
        "def fit(header):\n    header.resized.connect(lambda: print(header))",
        "def fit(table):\n    header = table.header()\n    header.resized.connect(lambda: print(header))",
        "def fit(header):\n    def resized():\n        print(header)\n    header.resized.connect(resized)",
        "def fit(header):\n    header.resized.connect(partial(print, header))",
        "def fit(bars):\n    for bar in bars:\n        bar.moved.connect(lambda bar=bar: print(bar))",
        "def ask(self):\n    self.task = task = ReadTask()\n    task.ended.connect(lambda: print(task))",
    ],
)
def test_what_holds_its_own_sender_is_found(code):
    assert held_by_their_own_signals(code)


@pytest.mark.parametrize(
    "code",
    [
        "def ask(self):\n    button = QPushButton(self)\n    button.clicked.connect(lambda: print(button))",
        "def ask(self):\n    self.timer = timer = QTimer()\n    timer.timeout.connect(lambda: print(timer))",
        "def ask(self):\n    self.task = task = ReadTask()\n    task.ended.connect(self.fit)",
        "def fit(self, header):\n    header.resized.connect(self.fit)",
        "def fit(header, name):\n    header.resized.connect(lambda: print(name))",
    ],
)
def test_what_python_keeps_is_not_named(code):
    assert held_by_their_own_signals(code) == []
