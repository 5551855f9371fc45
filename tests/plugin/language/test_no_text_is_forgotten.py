"""What people read goes through ``tr``: found in the source, so that no text comes back untranslated."""

from __future__ import annotations

import ast
import functools
import itertools
import re
import string
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from fleet_supervisor.plugin.panel.alarms.rules import AlarmKind

from tools.syntax import tree_of

ROOT = Path(__file__).parents[3]
TRANSLATED = ("tr", "tr_count", "tr_page")
WORD = re.compile(r"[^\W\d_]{2,}")
PROSE = re.compile(r"[^\W\d_]{2,}[,.;:…']? +[(\"']?[^\W\d_]")
"""Two words in a row."""
MNEMONIC = re.compile(r"^\w* ?&[^\W\d_][^\W\d_ ]+(?![\w=;])")
"""A label with a letter for the keyboard, wherever it is kept until it is shown."""
SHOWS = re.compile(
    r"""^(\w*Action|Q(gs)?(Label|PushButton|ToolButton|CheckBox|RadioButton|GroupBox|Menu|DockWidget)
    |QgsProcessing(Parameter|Output)\w+
    |set(Text|ToolTip|StatusTip|WhatsThis|WindowTitle|Title|PlaceholderText|SpecialValueText|Prefix
        |Suffix|HeaderLabels|HorizontalHeaderLabels|LabelText|InformativeText|EvalErrorString|Filter)
    |add(Row|Tab|Item|Items|Action|Menu|Button|Section|ToolBar)|insert(Item|Tab)
    |push(Message|Info|Warning|Critical)|showText|get(Open|Save)FileName|question|information|emit
    |(?!(Value|Key|Type|Assertion)Error)\w+Error)$""",
    re.VERBOSE,
)
"""What puts its arguments before people, or raises an error that is shown in its own words."""
BUILT_IN = ("ValueError", "KeyError", "TypeError", "AssertionError")
"""What is raised for whoever calls a function wrongly, or sends what breaks the protocol."""
SHOWN_KEYWORDS = ("text", "title", "tip", "description")

EVERYWHERE = {
    r"^[A-Z_]+$": "the names of Processing's parameters and outputs, which scripts write",
    r"^Fleet( Supervisor)?$": "a proper name",
    r"^\s*(Q\w+(#\w+)? \{)?[^{}]*\b(color|background|border|font-weight|padding):? ?[^{}]*;": "a style sheet",
    r"^ENGCRS\[": "a CRS in the words of its standard",
    r"^(SELECT|INSERT( OR REPLACE)? INTO|UPDATE|PRAGMA|DROP TRIGGER) ": "SQL",
    r" SET data = | WHERE nodeno = | IS NULL( |$)": "parts of SQL",
    r"<(svg|text|path|rect|span|img|p style)\b|^</b> &nbsp;<span": "markup without words of its own",
}
"""What need not be translated in any file, as a pattern of the text, and why."""
SQL_FILE = "plugin/layers/publishing/postgis.py"
SQL = re.compile(
    r"""^([ ;]*(select|insert\ into|delete\ from|create|drop|grant|savepoint|rollback\ to|set\ lock_timeout)\b
    |\ to\ $)|%s|\ (as\ select|geom|from\ stdin|using\ gist)\b""",
    re.VERBOSE,
)
"""Statements in lower case, and parts of some, which stand in that file alone."""
TEXTS = {
    "postgres": "the name of a provider of QGIS's",
    "Line Ticks Up": "a style of QGIS's scale bars",
    "Sans Serif": "a font",
    "QGIS (QgsGraphAnalyzer)": "the name of an engine, as robot-bridge tells those of the others",
    "another way": "a word of the protocol",
    "every queue": "the key that newest news of all queues are kept under",
    "every plan": "the key that newest news of all cone plans are kept under",
    "stage": "the field of a layer that is read unless another is named",
    "yyyy-MM-dd HH:mm:ss": "how Qt is told a format",
    "listening on (ws://127\\.0\\.0\\.1:\\d+)": "what is looked for in the log of the practice gateway",
    "EPSG:00000": "as wide as the codes of most CRSs",
    "a number of site ": "of a message that breaks the protocol",
    "the gateway's clock": "of a message that breaks the protocol",
    "fleet reading": "the name of a thread",
    "fleet road_surface ": "a key of a cache",
    "traffic cone": "a label that robots read on their maps",
    "emergency stop": "what is looked for in a gateway's refusal",
    "asks and cones": "a word of the protocol",
    "give way": "the protocol's word for what a robot can do",
    **dict.fromkeys(
        ("to the left", "to the right", "left limit", "right limit"),
        "the bridge's word for a choice of a layout's dimension, with the operator's word beside it",
    ),
    **dict.fromkeys(("), (SELECT max(rowid) FROM ", " WHERE rowid BETWEEN ? AND ?"), "a part of a query"),
    **dict.fromkeys(("PyVRP", "RoutingKit", "SciPy", "QGIS", "GeoJSON", "GeoPackage"), "a proper name"),
    **{kind.value: "the value that a kind of alarm is kept under, beside its words" for kind in AlarmKind},
}
"""Texts that nobody reads as they are, or that have to stay as they are, and why."""


syntax_of = functools.cache(tree_of)
"""Each source is looked through by three tests."""


def sources() -> list[Path]:
    return [path for path in sorted((ROOT / "plugin").rglob("*.py")) if "vendor" not in path.parts]


def forgotten(source: str) -> list[tuple[int, str]]:
    """Return line and text of what people read in ``source`` and is not translated."""
    tree = syntax_of(source)
    passed_over = set(_ids_passed_over(tree))
    shown = {id(text) for call in _calls(tree) for text in _texts_of(call)}
    shown |= set(_ids_beside_translated(tree))
    found = {}
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Constant) and isinstance(node.value, str)) or id(node) in passed_over:
            continue
        text = node.value
        reads = PROSE.search(text) or MNEMONIC.search(text) or (id(node) in shown and WORD.search(text))
        if reads and text not in TEXTS and not any(re.search(kind, text) for kind in EVERYWHERE):
            found[id(node)] = node.lineno, text
    return sorted(found.values())


def _ids_passed_over(tree: ast.AST) -> Iterator[int]:
    """Yield docstrings, what is translated, words to search by, and errors that are not the operator's."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield id(node.value)
        if _is_translation(node):
            yield from map(id, node.args)
        is_tags = isinstance(node, ast.Assign) and any(_name(one) == "TAGS" for one in node.targets)
        is_built_in = isinstance(node, ast.Call) and _called(node) in BUILT_IN
        if is_tags or is_built_in:
            yield from (id(part) for part in ast.walk(node) if isinstance(part, ast.Constant))


def _ids_beside_translated(tree: ast.AST) -> Iterator[int]:
    """Yield what stands in place of a translated text: in a dictionary, a choice, or a column of rows."""
    for node in ast.walk(tree):
        for alternatives in _alternatives(node):
            if any(_is_translation(one) for one in alternatives):
                yield from map(id, alternatives)


def _alternatives(node: ast.AST) -> Iterator[Sequence[ast.AST]]:
    """Yield expressions of ``node`` of which one is taken as well as another."""
    if isinstance(node, ast.Dict):
        yield node.values
    elif isinstance(node, ast.IfExp):
        yield node.body, node.orelse
    elif isinstance(node, (ast.List, ast.Tuple)):
        rows = [row.elts for row in node.elts if isinstance(row, ast.Tuple)]
        if len(rows) == len(node.elts):
            yield from itertools.zip_longest(*rows)


def _is_translation(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and _called(node) in TRANSLATED


def _calls(tree: ast.AST) -> Iterator[ast.Call]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and (SHOWS.match(_called(node)) or _is_translation(node)):
            yield node


def _texts_of(call: ast.Call) -> Iterator[ast.Constant]:
    """Yield the literals among a call's arguments, and the pieces of what is put together there."""
    fills_in = _called(call) in TRANSLATED
    for keyword in call.keywords:
        if fills_in or keyword.arg in SHOWN_KEYWORDS:
            yield from _literals(keyword.value)
    for argument in () if fills_in else call.args:
        yield from _literals(argument)


def _literals(node: ast.AST) -> Iterator[ast.Constant]:
    if isinstance(node, ast.Constant):
        yield node
    elif isinstance(node, (ast.JoinedStr, ast.IfExp, ast.BoolOp, ast.BinOp, ast.List, ast.Tuple)):
        for part in ast.iter_child_nodes(node):
            yield from _literals(part)


def _called(call: ast.Call) -> str:
    return _name(call.func)


def _name(node: ast.AST) -> str:
    return getattr(node, "id", None) or getattr(node, "attr", "")


@pytest.mark.parametrize(
    "line",
    [
        'raise NotSentError(f"{robot} was not sent: {why}")',
        'button.setText("Send")',
        'button.setText("Stop" if busy else "Load")',
        'form.addRow("&Height", field)',
        'rows = (("&Token", field), (tr("CA &file"), other))',
        'TITLE = "Export robot map"',
        'text += f" and {count} more of them"',
        'QgsProcessingParameterNumber(WIDTH, "Width [m]")',
        'DockAction(iface, text="Replay")',
        'tr("{robots} robots", robots="no" if none else count)',
        'WORDS = {DONE: "done", OPEN: tr("open")}',
        'where = tr("on the map") if place else "anywhere"',
        'for data, text in ((HERE, tr("here")), (ALL, "everything")): fill(data, text)',
    ],
)
def test_a_text_that_is_not_translated_is_found(line):
    assert forgotten(line)


@pytest.mark.parametrize(
    "line",
    [
        'raise NotSentError(tr("{robot} was not sent: {why}", robot=robot, why=why))',
        'button.setObjectName("fleet_send")',
        '"""What this is for, in words."""',
        'TAGS = ("traffic cone", "skid pad")',
        'label.setStyleSheet("color: #C62828; font-weight: bold;")',
        'QgsProcessingOutputNumber("FILE_COUNT", tr("Files"))',
        'layer = QgsVectorLayer("Point?&field=height:double", name, "memory")',
        'raise ValueError(f"{role} is no role of a layer")',
    ],
)
def test_what_is_translated_or_not_read_is_left_alone(line):
    assert not forgotten(line)


def test_every_text_that_people_read_is_translated():
    left = {}
    for path in sources():
        name = path.relative_to(ROOT).as_posix()
        for line, text in forgotten(path.read_text(encoding="utf-8")):
            if name != SQL_FILE or not SQL.search(text):
                left[f"{name}:{line}"] = text
    assert not left, "wrap them in tr(...) of plugin/ui/language.py, or say in TEXTS why nobody reads them"


def test_no_exception_is_for_what_is_gone():
    trees = [syntax_of(path.read_text(encoding="utf-8")) for path in sources()]
    known = {node.value for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    assert {one for one in TEXTS if one not in known} == set()


def test_every_placeholder_is_given_its_value():
    """A text that is shown once in a blue moon must not fail then."""
    wrong = []
    for path in sources():
        for call in _translations(syntax_of(path.read_text(encoding="utf-8"))):
            given = {keyword.arg for keyword in call.keywords}
            if None in given:
                # Values that come as a dictionary are not told from the source.
                continue
            for text in _texts_to_fill_in(call):
                missing = _placeholders(text) - given if given else set()
                too_many = given - _placeholders(text) if _called(call) == "tr" else set()
                if missing or too_many:
                    wrong.append((f"{path.relative_to(ROOT)}:{call.lineno}", text, missing, too_many))
    assert wrong == []


def _translations(tree: ast.AST) -> Iterator[ast.Call]:
    return (node for node in ast.walk(tree) if _is_translation(node))


def _texts_to_fill_in(call: ast.Call) -> list[str]:
    return [one.value for one in call.args if isinstance(one, ast.Constant) and isinstance(one.value, str)]


def _placeholders(text: str) -> set[str]:
    fields = (name for _, name, _, _ in string.Formatter().parse(text) if name is not None)
    return {re.split(r"[.\[]", name)[0] for name in fields}
