"""The operator's guide against the desk: each key, menu entry and button that it names is there."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from fleet_supervisor.plugin.ui.actions import EMERGENCY_KEYS, KEYS
from qgis.PyQt.QtWidgets import QAction, QMenu

from tools.syntax import tree_of

ROOT = Path(__file__).parents[2]
KEY = re.compile(r"[\w+]*\bF\d+|Ctrl\+K|Pause")
OF_QGIS = {"F1", "Ctrl+K"}
"""Keys of the table that are no shortcut of the plugin's."""
KEYS_IN_TEXT = {
    *("Alt", "Ctrl", "Shift", "Backspace", "Delete", "End", "Enter", "Esc", "Home", "Insert", "R", "Space"),
    *("Ctrl+Enter", "Ctrl+Shift+Z", "Ctrl+V", "Ctrl+Z", "<", ">"),
}
EMPHASIS = {
    *("A published site", "Find a robot", "In expressions", "Rest the mouse on a robot", "Select"),
    *("Print them", "Styles"),
    *("What a robot is told", "What each layer is to robots", "What is wrong with a map"),
    "Without a link nothing can be sent: use the robots' own emergency stops.",
    *("it is", "nothing on that map is live", "pauses", "send a robot", "the map", "token"),
}
"""What is in bold and is no text of the desk's."""


@pytest.fixture(scope="module")
def guide():
    return (ROOT / "docs" / "operator.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def rows(guide):
    """The rows of the table of keys: the keys, and what they do."""
    table = guide.split("\n## Keys\n")[1].split("\n## ")[0]
    cells = [line.strip("|").split("|") for line in table.splitlines() if line.startswith("| ")][1:]
    return [
        (re.findall(r"[\w+]*\bF\d+|Ctrl\+K|Pause", keys), does.strip().split(", ")) for keys, does in cells
    ]


def plain(text):
    """A text without the mark of its letter and without the dots of a dialog."""
    return text.replace("&", "").rstrip("… ")


def test_the_table_has_every_key_and_no_other(rows):
    named = [key for keys, _ in rows for key in keys]
    assert sorted(named) == sorted([*KEYS.values(), *EMERGENCY_KEYS, *OF_QGIS])


def test_each_key_does_what_the_table_says(plugin, iface, rows):
    actions = {plain(action.text()): action.objectName() for action in iface.findChildren(QAction)}
    named = [
        (key, name)
        for keys, names in rows
        if len(keys) == len(names)
        for key, name in zip(keys, names, strict=True)
        if name in actions
    ]
    assert len(named) > 12
    assert [(key, name) for key, name in named if KEYS.get(actions[name]) != key] == []


def test_each_entry_of_the_menu_that_is_named_is_there(plugin, iface, guide):
    entries = {plain(action.text()) for action in iface.plugins.actions()}
    named = set(re.findall(r"\*Plugins → Fleet Supervisor → ([^*]+)\*", guide))
    named |= set(re.findall(r"\*\*([^*]+)\*\*,? in (?:the menu )?\*Plugins → Fleet Supervisor\*", guide))
    assert len(named) > 7
    assert {plain(name) for name in named} <= entries
    drafts = iface.mainWindow().findChild(QMenu, "fleet_draft_menu")
    within = rf"\*\*([^*]+)\*\* in the menu \*Plugins → Fleet Supervisor → {plain(drafts.title())}\*"
    of_drafts = set(map(plain, re.findall(within, guide)))
    assert of_drafts and of_drafts <= {plain(action.text()) for action in drafts.actions()}


def test_what_is_in_bold_stands_at_the_desk(guide):
    sources = [file.read_text(encoding="utf-8") for file in (ROOT / "plugin").rglob("*.py")]
    nodes = (node for source in sources for node in ast.walk(tree_of(source)))
    texts = {str(node.value) for node in nodes if isinstance(node, ast.Constant)}
    bold = set(re.findall(r"\*\*([^*]+)\*\*", guide))
    assert len(bold) > 80
    there = set(map(plain, texts))
    assert {name for name in bold if plain(name) not in there} <= KEYS_IN_TEXT | EMPHASIS
