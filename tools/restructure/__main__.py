"""Restructure the tree by maps of paths.

python -m tools.restructure --check MAP...     what would collide, which imports would go round, how large
python -m tools.restructure MAP...             do it; then ruff sorts imports and formats
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import textwrap
from collections import defaultdict
from pathlib import Path

from .. import structure
from .naming import Naming, top_imports
from .rewriting import Edit, Rewriter, apply, renamed_text
from .tree import ROOT, TOPS, Module, Plan, Target, complete, moved, read_maps

PYTHON = ("plugin", "robot_bridge", "tests", "scripts", "resources", "tools", "benchmarks")
TEXTS = (
    "*.md",
    "*.toml",
    "*.ini",
    "*.cfg",
    "*.sh",
    "*.txt",
    "*.yml",
    "*.yaml",
    "*.service",
    "*.json",
    "Makefile",
    "*.ts",
)
KEPT = ("CHANGELOG.md", "tools/")


def tracked(patterns: tuple[str, ...]) -> list[str]:
    """Return the paths of tracked files that fit."""
    listed = subprocess.run(
        ["git", "ls-files", "--", *patterns], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [p for p in listed.stdout.splitlines() if not p.startswith(KEPT)]


def load() -> dict[str, Module]:
    """Read every tracked Python file, by path."""
    return {
        p: Module(p, (ROOT / p).read_text(encoding="utf-8"))
        for p in tracked(("*.py",))
        if p == "__init__.py" or p.split("/")[0] in PYTHON
    }


def ordered(target: Target, modules: dict[str, Module], naming: Naming) -> list[Module]:
    """Return a target's sources so that each comes after those it imports."""
    sources = [modules[p] for p in target.sources]
    names = {m.name: m for m in sources}
    done: dict[str, Module] = {}

    def add(module: Module, path: tuple[str, ...]) -> None:
        if module.name in done or module.name in path:
            return
        for node in module.tree.body:
            if node in top_imports([node]):
                for _, identity in naming.identities(module, node):
                    if identity[0] in ("own", "mod") and identity[1] in names and identity[1] != module.name:
                        add(names[identity[1]], (*path, module.name))
        done[module.name] = module

    for module in sources:
        add(module, ())
    return list(done.values())


def assemble(target: Target, sources: list[Module], rewriters: dict[str, Rewriter]) -> str:
    """Return the text of a target that is made of several sources, or has a new docstring."""
    parts, imports = [], ["from __future__ import annotations"]
    docstring = target.docstring
    for index, module in enumerate(sources):
        rewriter = rewriters[module.name]
        imports += rewriter.imports
        edits = _without(rewriter.edits, rewriter.dropped)
        first = module.tree.body[0] if module.tree.body else None
        said = ""
        if first is not None and _is_text(first):
            said = renamed_text(first.value.value, rewriter.naming)  # type: ignore[attr-defined]
            start, end = module.span(first)
            edits = [*[e for e in edits if not (start <= e[0] < end)], (start, end, "")]
        body = apply(module.raw, sorted(set(edits))).decode().strip("\n")
        body = re.sub(r"\A(?:\s*\n)+", "", body)
        if docstring is None and index == 0:
            docstring = said
            parts.append(body)
        else:
            parts.append(_section(said) + "\n\n" + body)
    head = f'"""{docstring}"""'
    return "\n".join(
        [head, "", *dict.fromkeys(imports), "", "\n\n\n".join(p for p in parts if p.strip()), ""]
    )


def _without(edits: list[Edit], dropped: list[tuple[int, int]]) -> list[Edit]:
    kept = [e for e in edits if not any(start <= e[0] < end for start, end in dropped)]
    return [*kept, *[(start, end, "") for start, end in dropped]]


def _is_text(node: object) -> bool:
    value = getattr(node, "value", None)
    return isinstance(getattr(value, "value", None), str) and type(node).__name__ == "Expr"


def _section(docstring: str) -> str:
    lines = docstring.strip("\n").split("\n")
    first = lines[0].rstrip(".")
    rest = [f"# {part}".rstrip() for line in lines[1:] for part in textwrap.wrap(line, 106) or [""]]
    while rest and rest[0] == "#":
        rest.pop(0)
    while rest and rest[-1] == "#":
        rest.pop()
    head = f"# --- {first} ---" if len(first) <= 96 else f"# --- {first}"
    return "\n".join([head, *rest])


def report_graph(texts: dict[str, str], under: str = "") -> bool:
    """Print circles, sizes and floors of the new tree; whether there are circles."""
    graph = structure.graph_of(texts)
    found = list(structure.sibling_circles(graph))
    for circle, arrows in found:
        print("CIRCLE", ", ".join(circle), *arrows, sep="\n    ")
    sizes = {p: len(t.splitlines()) for p, t in texts.items() if p.split("/")[0] in TOPS}
    for path, lines in sorted(sizes.items()):
        if under and path.startswith(under):
            print(f"{lines:5d} {path}")
    for folder in sorted({p.rpartition("/")[0] for p in sizes}):
        if folder.startswith(under):
            inside = [n for p, n in sizes.items() if p.rpartition("/")[0] == folder]
            height = structure.floors(graph, folder.replace("/", "."))
            print(f"folder {folder}: {len(inside)} modules, {sum(inside)} lines, {height} floors")
    lone = structure.lone_modules(graph)
    print(f"{len(sizes)} modules, {sum(sizes.values())} lines, {len(lone)} with one importer in its folder")
    return bool(found)


def main() -> int:
    """Read the maps, check them, and carry them out unless only checked."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--under", default="", help="tell only of targets below this path")
    parser.add_argument("maps", nargs="+", type=Path)
    arguments = parser.parse_args()
    modules = load()
    plan = read_maps(arguments.maps)
    product = {p: m for p, m in modules.items() if p.split("/")[0] in TOPS}
    targets = complete(plan, product)
    naming = named(plan, targets, modules)
    rewriters = rewrite(naming, modules, targets)
    texts = {t.path: text_of(t, modules, rewriters, naming) for t in targets.values()}
    problems = [p for r in rewriters.values() for p in r.problems]
    for line in [*naming.collisions, *problems]:
        if line.startswith(arguments.under) or arguments.under in line:
            print(line)
    circles = report_graph(texts, arguments.under)
    if arguments.check:
        return 1 if circles else 0
    carry_out(plan, modules, targets, rewriters, texts, naming)
    return 0


def named(plan: Plan, targets: dict[str, Target], modules: dict[str, Module]) -> Naming:
    """Return what everything is called in the new tree."""
    new_of = {modules[s].name: t.name for t in targets.values() for s in t.sources}
    old_packages = {m.name: m for m in modules.values() if m.is_package and m.path.split("/")[0] in TOPS}
    for name, module in old_packages.items():
        if name not in new_of:
            new_of[name] = moved(module.path, plan.folders).removesuffix("/__init__.py").replace("/", ".")
    naming = Naming({m.name: m for m in modules.values()}, new_of, targets, plan)
    new_of[""] = ""
    for path in targets:
        targets[path].sources = [m.path for m in ordered(targets[path], modules, naming)]
    naming.assign()
    return naming


def rewrite(naming: Naming, modules: dict[str, Module], targets: dict[str, Target]) -> dict[str, Rewriter]:
    """Return the edits of every file, by the module's old name."""
    place = {s: t for t in targets.values() for s in t.sources}
    rewriters = {}
    for path, module in modules.items():
        if path not in place and path.split("/")[0] in TOPS:
            continue
        target = place.get(path)
        rewriters[module.name] = Rewriter(naming, module, target)
        rewriters[module.name].run(merged=target is not None and _is_assembled(target))
    return rewriters


def _is_assembled(target: Target) -> bool:
    return len(target.sources) > 1 or target.docstring is not None


def text_of(
    target: Target, modules: dict[str, Module], rewriters: dict[str, Rewriter], naming: Naming
) -> str:
    """Return a target's new text."""
    sources = [modules[p] for p in target.sources]
    if _is_assembled(target):
        return assemble(target, sources, rewriters)
    rewriter = rewriters[sources[0].name]
    return apply(rewriter.module.raw, _without(rewriter.edits, rewriter.dropped)).decode()


def carry_out(
    plan: Plan,
    modules: dict[str, Module],
    targets: dict[str, Target],
    rewriters: dict[str, Rewriter],
    texts: dict[str, str],
    naming: Naming,
) -> None:
    """Write the new tree: files moved by git, so that history follows, then everything that names them."""
    gone = {p for p in modules if p.split("/")[0] in TOPS} - set(targets)
    spoken = {m.path: _docstring(m) for m in modules.values() if m.is_package}
    for target in targets.values():
        (ROOT / target.path).parent.mkdir(parents=True, exist_ok=True)
        main = max(target.sources, key=lambda p: len(modules[p].text))
        if main != target.path and not (ROOT / target.path).exists():
            subprocess.run(["git", "mv", main, target.path], cwd=ROOT, check=True)
    for path in gone:
        (ROOT / path).unlink(missing_ok=True)
    for path, text in texts.items():
        (ROOT / path).write_text(text, encoding="utf-8")
    _packages(plan, targets, spoken)
    for module in modules.values():
        if module.path.split("/")[0] not in TOPS:
            (ROOT / module.path).write_text(rewriters[module.name].text(), encoding="utf-8")
    for path in tracked(TEXTS):
        if (ROOT / path).is_file():
            old = (ROOT / path).read_text(encoding="utf-8")
            new = renamed_text(old, naming)
            if new != old:
                (ROOT / path).write_text(new, encoding="utf-8")
    ruff = Path(sys.executable).with_name("ruff")
    subprocess.run(
        [ruff, "check", "-q", "--select", "I,F401,F811,RUF022", "--fix", "--exit-zero", "."],
        cwd=ROOT,
        check=True,
    )
    subprocess.run([ruff, "format", "-q", "."], cwd=ROOT, check=True)


def _docstring(module: Module) -> str:
    return module.text.strip()


def _packages(plan: Plan, targets: dict[str, Target], spoken: dict[str, str]) -> None:
    """Give every package an ``__init__``, and take those of folders that hold nothing more away."""
    needed = {str(parent) for p in targets for parent in list(Path(p).parents)[:-1]}
    old: dict[str, str] = defaultdict(str)
    for path, text in spoken.items():
        old[moved(str(Path(path).parent), plan.folders)] = text
    for folder in needed:
        init = ROOT / folder / "__init__.py"
        if f"{folder}/__init__.py" in targets:
            continue
        said = plan.packages.get(folder)
        text = f'"""{said}"""\n' if said else (old[folder] + "\n" if old[folder] else "")
        init.write_text(text, encoding="utf-8")
    for top in TOPS:
        for folder in sorted((ROOT / top).rglob("*"), reverse=True):
            rest = [f for f in folder.iterdir() if f.name != "__pycache__"] if folder.is_dir() else [folder]
            if folder.is_dir() and folder.name != "__pycache__" and not rest:
                for cached in folder.glob("__pycache__/*"):
                    cached.unlink()
                if (folder / "__pycache__").exists():
                    (folder / "__pycache__").rmdir()
                folder.rmdir()


if __name__ == "__main__":
    sys.exit(main())
