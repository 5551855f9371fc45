"""How the source is laid out, in figures: modules, lines, floors of imports, circles, names that stand twice.

    python tools/structure.py            the table, and every circle of imports
    python tools/structure.py --list     with what is behind the figures
    python tools/structure.py --write    into docs/architecture.md

Counted from imports and the syntax tree of plugin/ and robot_bridge/. A module has more than a docstring.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[1]
TOPS = ("plugin", "robot_bridge")
ASIDE = ("robot_bridge.links", "robot_bridge.reference_robot.localisation")
"""What the first two figures leave out: adapters, and the robot that finds itself."""
GENERIC_VERBS = frozenset({"take", "put", "look", "tell", "give", "see", "go"})

OF_LIBRARIES = frozenset(
    {
        *("buffer_text", "CharacterDataHandler", "EndElementHandler", "StartDoctypeDeclHandler"),
        *("StartElementHandler", "max_message_size", "max_sequence_length"),
    }
)
"""Attributes that expat, websockets and rosbags have set from outside, and offer no other way to set."""

Graph = dict[str, set[str]]


def dotted(path: str) -> str:
    """Return the module's name of a path from the root, such as ``plugin/panel/dock.py``."""
    return path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def graph_of(texts: dict[str, str]) -> Graph:
    """Return the modules that each module imports anywhere in its text, by relative imports."""
    names = {dotted(path) for path in texts}
    graph: Graph = {name: set() for name in names}
    for path, text in texts.items():
        name = dotted(path)
        parts = (name if path.endswith("__init__.py") else name.rpartition(".")[0]).split(".")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ImportFrom) and node.level:
                base = parts[: len(parts) - (node.level - 1)]
                source = ".".join([*base, *([node.module] if node.module else [])])
                for alias in node.names:
                    whole = f"{source}.{alias.name}"
                    found = whole if whole in names else source if source in names else None
                    if found and found != name:
                        graph[name].add(found)
    return graph


def circles(graph: Graph) -> list[list[str]]:
    """Return the strongly connected components of more than one node."""
    order: list[str] = []
    seen: set[str] = set()
    for start in sorted(graph):
        if start not in seen:
            order += _finished(graph, start, seen)
    back: Graph = defaultdict(set)
    for one, others in graph.items():
        for other in others:
            back[other].add(one)
    seen, found = set(), []
    for start in reversed(order):
        if start not in seen:
            part = _finished(back, start, seen)
            if len(part) > 1:
                found.append(sorted(part))
    return found


def _finished(graph: Graph, start: str, seen: set[str]) -> list[str]:
    """Return what is reached from ``start`` and not yet seen, each after all that it leads to."""
    seen.add(start)
    work, done = [(start, iter(sorted(graph.get(start, ()))))], []
    while work:
        node, rest = work[-1]
        following = next((n for n in rest if n not in seen), None)
        if following is None:
            done.append(node)
            work.pop()
        else:
            seen.add(following)
            work.append((following, iter(sorted(graph.get(following, ())))))
    return done


def sibling_graph(graph: Graph, package: str) -> tuple[Graph, dict[tuple[str, str], list[str]]]:
    """Return who imports whom among a package's children, and the imports behind each arrow."""
    depth = package.count(".") + 2
    edges: Graph = defaultdict(set)
    why: dict[tuple[str, str], list[str]] = defaultdict(list)
    for one, others in graph.items():
        if one.startswith(package + "."):
            a = ".".join(one.split(".")[:depth])
            edges[a] |= set()
            for other in others:
                b = ".".join(other.split(".")[:depth])
                if other.startswith(package + ".") and a != b:
                    edges[a].add(b)
                    why[a, b].append(f"{one} -> {other}")
    return edges, why


def packages_of(graph: Graph) -> list[str]:
    """Return every package above a module."""
    return sorted({".".join(n.split(".")[:i]) for n in graph for i in range(1, n.count(".") + 1)})


def sibling_circles(graph: Graph) -> Iterator[tuple[list[str], list[str]]]:
    """Return circles between children of one package, each with the rarest of the imports that make it."""
    for package in packages_of(graph):
        edges, why = sibling_graph(graph, package)
        for circle in circles(edges):
            inside = set(circle)
            arrows = sorted((len(r), a, b, r) for (a, b), r in why.items() if {a, b} <= inside)
            yield circle, [f"{a} -> {b}: {n} times, such as {'; '.join(r[:3])}" for n, a, b, r in arrows]


def floors(graph: Graph, package: str) -> int:
    """Return the number of modules in the longest chain of imports among a package's children."""
    edges, _ = sibling_graph(graph, package)
    known: dict[str, int] = {}

    def height(node: str, path: frozenset[str] = frozenset()) -> int:
        if node in path:
            return 0
        if node not in known:
            known[node] = 1 + max((height(n, path | {node}) for n in edges.get(node, ())), default=0)
        return known[node]

    return max((height(node) for node in list(edges)), default=0)


def lone_modules(graph: Graph) -> list[str]:
    """Return the modules that exactly one module imports, and one of the same folder."""
    importers: dict[str, list[str]] = defaultdict(list)
    for one, others in graph.items():
        for other in others:
            importers[other].append(one)
    folder = {n: n.rpartition(".")[0] for n in graph}
    return sorted(n for n, who in importers.items() if len(who) == 1 and folder[who[0]] == folder[n])


@dataclass
class Figure:
    """One line of the table, with what is behind it."""

    name: str
    value: int | str
    goal: str
    behind: list[str]


def read_texts(root: Path) -> dict[str, str]:
    """Return the text of every module that holds more than a docstring, by its path from the root."""
    texts = {}
    for top in TOPS:
        for path in sorted((root / top).rglob("*.py")):
            text = path.read_text(encoding="utf-8")
            if path.name != "__init__.py" or len(ast.parse(text).body) > 1:
                texts[path.relative_to(root).as_posix()] = text
    return texts


def figures(root: Path) -> list[Figure]:
    """Return all figures of the tree at ``root``."""
    texts = read_texts(root)
    graph = graph_of(texts)
    counted = {p: t for p, t in texts.items() if not dotted(p).startswith(ASIDE)}
    lines = sum(len(t.splitlines()) for t in counted.values())
    lone = [n for n in lone_modules(graph) if not n.startswith(ASIDE)]
    folders = Counter(p.rpartition("/")[0] for p in texts)
    heights = {p: floors(graph, p) for p in packages_of(graph)}
    trees = {p: ast.parse(t) for p, t in texts.items()}
    classes = _named_twice(trees)
    verbs = sorted(_generic_methods(trees))
    functions = sorted(_function_parameters(trees))
    hooks = sorted(_set_from_outside(trees))
    imports = sum(_import_lines(tree) for tree in trees.values())
    everything = sum(len(t.splitlines()) for t in texts.values())
    exceptions = _contract_exceptions(root)
    return [
        Figure("modules, without links and localisation", len(counted), "≤ 350", _sizes(counted)),
        Figure("lines of them", lines, "≤ 68 000 without new features", []),
        Figure("modules with one importer, in that importer's folder", len(lone), "≤ 40", lone),
        Figure("modules in the fullest package", max(folders.values()), "≤ 22", _most(folders)),
        Figure("floors of imports inside a package", max(heights.values()), "≤ 7", _most(Counter(heights))),
        Figure("exceptions in import contracts", len(exceptions), "0", exceptions),
        Figure("constructor parameters that are functions", len(functions), "≤ 15", functions),
        Figure("attributes of parts set from outside", len(hooks), "0", hooks),
        Figure("class names that stand twice", len(classes), "≤ 5", classes),
        Figure("public methods named take, put, look, tell, give, see, go", len(verbs), "0", verbs),
        Figure("import lines", f"{100 * imports / everything:.1f} %", "≤ 6 %", []),
        Figure("circles of imports", len(list(sibling_circles(graph))), "0", []),
    ]


def _sizes(texts: dict[str, str]) -> list[str]:
    sizes = Counter({p: len(t.splitlines()) for p, t in texts.items()})
    return [f"{n} {p}" for p, n in sizes.most_common(20)]


def _most(counted: Counter[str]) -> list[str]:
    return [f"{n} {name}" for name, n in counted.most_common(12)]


def _named_twice(trees: dict[str, ast.Module]) -> list[str]:
    where: dict[str, list[str]] = defaultdict(list)
    for path, tree in trees.items():
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                where[node.name].append(path)
    return [f"{n}: {', '.join(p)}" for n, p in sorted(where.items()) if len(p) > 1]


def _generic_methods(trees: dict[str, ast.Module]) -> Iterator[str]:
    for path, owner, node in _methods(trees):
        if node.name in GENERIC_VERBS:
            yield f"{path}: {owner.name}.{node.name}"


def _methods(trees: dict[str, ast.Module]) -> Iterator[tuple[str, ast.ClassDef, ast.FunctionDef]]:
    for path, tree in trees.items():
        for owner in ast.walk(tree):
            if isinstance(owner, ast.ClassDef):
                for node in owner.body:
                    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                        yield path, owner, node  # type: ignore[misc]


def _function_parameters(trees: dict[str, ast.Module]) -> Iterator[str]:
    """Return parameters of constructors, and fields of dataclasses, whose type is a function's."""
    for path, owner, node in _methods(trees):
        if node.name == "__init__":
            for argument in [*node.args.args, *node.args.kwonlyargs]:
                if argument.annotation and "Callable" in ast.unparse(argument.annotation):
                    yield f"{path}: {owner.name}({argument.arg})"
    for path, tree in trees.items():
        for owner in ast.walk(tree):
            if isinstance(owner, ast.ClassDef) and any(
                "dataclass" in ast.unparse(d) for d in owner.decorator_list
            ):
                for field in owner.body:
                    if isinstance(field, ast.AnnAssign) and "Callable" in ast.unparse(field.annotation):
                        yield f"{path}: {owner.name}({ast.unparse(field.target)})"


def _set_from_outside(trees: dict[str, ast.Module]) -> Iterator[str]:
    """Return assignments to an attribute of a part: ``self.part.attribute = ...``.

    A part is the project's own: what a library wants to be set from outside (OF_LIBRARIES) is its interface.
    """
    for path, tree in trees.items():
        for node in ast.walk(tree):
            targets = node.targets if isinstance(node, ast.Assign) else []
            for target in targets:
                holder = target.value if isinstance(target, ast.Attribute) else None
                if not isinstance(holder, ast.Attribute) or target.attr in OF_LIBRARIES:
                    continue
                if ast.unparse(holder).startswith("self."):
                    yield f"{path}:{node.lineno}: {ast.unparse(target)}"


def _import_lines(tree: ast.Module) -> int:
    found = [n for n in ast.walk(tree) if isinstance(n, (ast.Import, ast.ImportFrom))]
    return sum((n.end_lineno or n.lineno) - n.lineno + 1 for n in found)


def _contract_exceptions(root: Path) -> list[str]:
    settings = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    return [f"{c['name']}: {i}" for c in contracts for i in c.get("ignore_imports", [])]


def table_of(table: list[Figure]) -> str:
    """Return figures as a table in Markdown."""
    rows = ["| figure | now | goal |", "|---|---|---|"]
    for figure in table:
        value = f"{figure.value:,}".replace(",", " ") if isinstance(figure.value, int) else figure.value
        rows.append(f"| {figure.name} | {value} | {figure.goal} |")
    return "\n".join(rows)


def write_table(page: Path, text: str) -> None:
    """Put a table between the marks of a page, in place of the one that is there."""
    before, mark, rest = page.read_text(encoding="utf-8").partition("<!-- structure -->\n")
    if not mark:
        raise SystemExit(
            f"{page} has no line <!-- structure -->; put it, and <!-- end -->, where the table belongs"
        )
    _, end, after = rest.partition("<!-- end -->")
    page.write_text(before + mark + text + "\n" + end + after, encoding="utf-8")


def main() -> int:
    """Print the table; the status is 1 where imports go in a circle."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--list", action="store_true", help="print what is behind each figure")
    parser.add_argument("--write", action="store_true", help="put the table into docs/architecture.md")
    parser.add_argument("--root", type=Path, default=ROOT)
    arguments = parser.parse_args()
    table = figures(arguments.root)
    text = table_of(table)
    print(text)
    if arguments.write:
        write_table(arguments.root / "docs" / "architecture.md", text)
    for figure in table if arguments.list else []:
        print(f"\n{figure.name}:", *figure.behind, sep="\n  ")
    found = list(sibling_circles(graph_of(read_texts(arguments.root))))
    for circle, arrows in found:
        print("\ncircle:", ", ".join(circle), *arrows, sep="\n  ", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
