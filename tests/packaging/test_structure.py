"""tools/structure.py: who imports whom, and what the figures count."""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIGURES = (
    "modules, without links and localisation",
    "modules with one importer, in that importer's folder",
    "constructor parameters that are functions",
    "attributes of parts set from outside",
    "class names that stand twice",
    "circles of imports",
)


@pytest.fixture(scope="module")
def structure():
    spec = importlib.util.spec_from_file_location("structure", ROOT / "tools" / "structure.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["structure"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["structure"]


@pytest.fixture
def tree(tmp_path):
    """A small project: ``a.one`` uses ``a.two``, and ``b`` uses ``a``."""
    files = {
        "plugin/__init__.py": '"""A package."""\n',
        "plugin/a/one.py": "from .two import Two\nclass One:\n    def take(self): ...\n",
        "plugin/a/two.py": "class Two:\n    def __init__(self, on_end: Callable[[], None]): ...\n",
        "robot_bridge/b.py": "class Two:\n    def link(self):\n        self.part.hook = print\n",
        "robot_bridge/links/c.py": "",
        "pyproject.toml": "[tool.importlinter]\ncontracts = []\n",
    }
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    return tmp_path


def values(structure, root):
    return {figure.name: figure.value for figure in structure.figures(root)}


def test_figures_count_what_they_say(structure, tree):
    found = values(structure, tree)
    assert [found[name] for name in FIGURES] == [3, 1, 1, 1, 1, 0]
    assert found["public methods named take, put, look, tell, give, see, go"] == 1
    assert found["import lines"] == "12.5 %"


def test_a_circle_is_found_between_packages_too(structure, tree):
    (tree / "plugin" / "c").mkdir()
    (tree / "plugin" / "c" / "three.py").write_text("from ..a import one\n")
    (tree / "plugin" / "a" / "two.py").write_text("def f():\n    from ..c.three import x\n")
    graph = structure.graph_of(structure.read_texts(tree))
    circles = [circle for circle, _ in structure.sibling_circles(graph)]
    assert circles == [["plugin.a", "plugin.c"]]


def test_floors_are_the_longest_chain(structure):
    graph = {"p.a": {"p.b"}, "p.b": {"p.c.x"}, "p.c.x": set(), "p.d": {"p.c.x"}, "q": {"p.a"}}
    assert structure.floors(graph, "p") == 3


def test_the_table_is_put_between_the_marks(structure, tmp_path):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- structure -->\nold\n<!-- end -->\nafter\n")
    structure.write_table(page, "new")
    assert page.read_text() == "before\n<!-- structure -->\nnew\n<!-- end -->\nafter\n"
    page.write_text("no marks")
    with pytest.raises(SystemExit, match="has no line"):
        structure.write_table(page, "new")


def definitions(path: Path) -> set[str]:
    """Return the names of the functions and constants of a file, and ``Class.method`` of those in classes."""
    names = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign):
            names |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            names.add(node.name)
        elif isinstance(node, ast.ClassDef):
            inner = [each for each in node.body if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)]
            names |= {f"{node.name}.{each.name}" for each in inner}
    return names


FLOW = re.compile(r"^### ([^\n]+)\n(.*?)^\*\*(\d+) files: (\d+) in `plugin/`, (\d+) in", re.M | re.S)
ROW = re.compile(r"^\| \d+ \| `([^`]+)` \| (.+?) \|", re.M)
FLOWS = FLOW.findall((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8"))


def test_the_page_has_three_flows():
    assert len(FLOWS) == 3


@pytest.mark.parametrize("flow", FLOWS, ids=[name for name, *_ in FLOWS])
def test_each_function_of_a_flow_is_in_its_file(flow):
    _, table, *counts = flow
    rows = ROW.findall(table)
    files = [file for file, _ in rows]
    in_plugin = sum(file.startswith("plugin/") for file in files)
    assert list(map(int, counts)) == [len(set(files)), in_plugin, len(files) - in_plugin]
    named = {file: set(re.findall(r"`([^`]+)`", functions)) for file, functions in rows}
    assert {
        file: missing for file, names in named.items() if (missing := names - definitions(ROOT / file))
    } == {}
