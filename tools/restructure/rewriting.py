"""The text of a file with its imports, its names and what it says in strings brought up to the new tree."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import defaultdict
from dataclasses import dataclass, field

from .naming import Identity, Naming, defined
from .scopes import FUNCTIONS
from .tree import PACKAGE, TOPS, MapError, Module, Target

Edit = tuple[int, int, str]


@dataclass
class Rewriter:
    """Edits of one file. ``target`` is where it goes; None for tests, scripts and the root's ``__init__``."""

    naming: Naming
    module: Module
    target: Target | None
    edits: list[Edit] = field(default_factory=list)
    imports: list[str] = field(default_factory=list)
    dropped: list[tuple[int, int]] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    function: ast.AST | None = None
    """The outermost function around the statements that are edited."""

    def run(self, merged: bool) -> None:
        """Collect all edits; ``merged`` says that the file becomes part of another."""
        self._statements(self.module.tree.body, top=True, level=True, merged=merged)
        self._own_names()
        self._imported_names()
        self._lists()
        self._texts()
        self._depth()

    def text(self) -> str:
        """Return the whole file with its edits."""
        return apply(self.module.raw, self.edits).decode()

    # --- imports ---

    def _statements(self, body: list[ast.stmt], top: bool, level: bool, merged: bool) -> None:
        """Edit a body's imports: ``top`` is the module's own, ``level`` also those of its if and try."""
        imports = [n for n in body if isinstance(n, (ast.Import, ast.ImportFrom))]
        for node in body:
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                self._import(node, top and merged, level, alone=len(body) == len(imports))
            else:
                for name in ("body", "orelse", "finalbody"):
                    inner = getattr(node, name, None)
                    if isinstance(inner, list) and inner and isinstance(inner[0], ast.stmt):
                        function = isinstance(node, (*FUNCTIONS, ast.ClassDef))
                        outermost = isinstance(node, FUNCTIONS) and self.function is None
                        self.function = node if outermost else self.function
                        self._statements(inner, False, level and not function, merged)
                        self.function = None if outermost else self.function
                for handler in getattr(node, "handlers", []):
                    self._statements(handler.body, False, level, merged)
                for case in getattr(node, "cases", []):
                    self._statements(case.body, False, level, merged)

    def _import(self, node: ast.Import | ast.ImportFrom, gathered: bool, level: bool, alone: bool) -> None:
        lines, local = self._rewritten(node, level)
        start, end = self.module.span(node)
        if gathered:
            self.imports += lines
            self._drop_lines(start, end)
            return
        if not local and _says(lines) == _says([ast.unparse(node)]):
            return
        indent = " " * node.col_offset
        if not lines and not local:
            if alone and node not in self.module.tree.body:
                self.edits.append((start, end, "pass"))
            else:
                self._drop_lines(start, end)
            return
        self.edits.append((start, end, f"\n{indent}".join([*lines, *local])))

    def _drop_lines(self, start: int, end: int) -> None:
        raw = self.module.raw
        start = raw.rfind(b"\n", 0, start) + 1
        stop = raw.find(b"\n", end)
        self.edits.append((start, len(raw) if stop < 0 else stop + 1, ""))

    def _rewritten(self, node: ast.Import | ast.ImportFrom, top: bool) -> tuple[list[str], list[str]]:
        """Return the import's new lines, and assignments in place of names that are the module's own now."""
        naming = self.naming
        if isinstance(node, ast.Import):
            names = []
            for alias in node.names:
                local = alias.asname or alias.name
                key = ("lib", "import", alias.name, alias.asname or "")
                named = naming.local.get((self.target.path, key), local) if self.target and top else local
                if named != local:
                    names.append(f"import {alias.name} as {named}")
                else:
                    names.append(f"import {alias.name}" + (f" as {alias.asname}" if alias.asname else ""))
            return names, []
        by_place: dict[str, list[str]] = defaultdict(list)
        assigned: list[str] = []
        for local, identity in naming.identities(self.module, node):
            if identity[0] == "lib":
                name = identity[2]
                named = (
                    naming.local.get((self.target.path, identity), local) if self.target and top else local
                )
                by_place[identity[1]].append(name if named == name else f"{name} as {named}")
                continue
            place = naming.new_of[identity[1]]
            if self.target and place == self.target.name:
                if identity[0] == "own" and not top and local != naming.final_name(*identity[1:]):
                    assigned.append(f"{local} = {naming.final_name(*identity[1:])}")
                elif identity[0] == "mod" and not top:
                    self.problems.append(
                        f"{self.module.path}:{node.lineno}: imports {local} of its own module"
                    )
                continue
            named = self._local_name(local, identity, top)
            if identity[0] == "own":
                name = naming.final_name(identity[1], identity[2])
            else:
                place, _, name = place.rpartition(".")
            where = self._place(place, node)
            by_place[where].append(name if named == name else f"{name} as {named}")
        return [f"from {p} import {', '.join(dict.fromkeys(n))}" for p, n in by_place.items()], assigned

    def _local_name(self, local: str, identity: Identity, top: bool) -> str:
        naming = self.naming
        if self.target and top:
            return naming.local.get((self.target.path, naming.placed(identity)), local)
        if identity[0] == "mod" and top:
            return naming.module_alias(self.module, local, identity)
        if identity[0] == "own" and local == identity[2]:
            final = naming.final_name(identity[1], identity[2])
            if not top and final != local:
                self._rename_in_function(local, final)
            return final
        return local

    def _rename_in_function(self, local: str, final: str) -> None:
        for node in ast.walk(self.function) if self.function else ():
            if isinstance(node, ast.Name) and node.id == local:
                self.edits.append((*self.module.span(node), final))

    def _place(self, name: str, node: ast.ImportFrom) -> str:
        if self.target is None and self.module.path != "__init__.py":
            outside = node.level == 0 and (node.module or "").startswith(PACKAGE)
            return f"{PACKAGE}.{name}" if outside and name else PACKAGE if outside else name
        return self._relative(name)

    def _relative(self, name: str) -> str:
        """Return a module's name as the target imports it."""
        package = self.target.package.split(".") if self.target and self.target.package else []
        parts = name.split(".") if name else []
        common = 0
        while common < min(len(package), len(parts)) and package[common] == parts[common]:
            common += 1
        return "." * (len(package) - common + 1) + ".".join(parts[common:])

    # --- names ---

    def _own_names(self) -> None:
        """Rename what the module defines at its own level, where the new one calls it something else."""
        if self.target is None:
            return
        for name in defined(self.module):
            final = self.naming.final_name(self.module.name, name)
            if final != name:
                self._rename_uses(name, final)
                for node in self.module.tree.body:
                    if isinstance(node, (*FUNCTIONS, ast.ClassDef)) and node.name == name:
                        start = self.module.offset(node.lineno, node.col_offset)
                        head = re.compile(rb"(?:async\s+def|def|class)\s+").match(self.module.raw, start)
                        assert head
                        self.edits.append((head.end(), head.end() + len(name.encode()), final))
        for node in self.module.tree.body:
            names = self._names_of(node)
            if names and all((self.module.name, n) in self.naming.same for n in names):
                self.dropped.append(self._whole(node))

    @staticmethod
    def _names_of(node: ast.stmt) -> list[str]:
        if isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            return [node.name]
        if isinstance(node, ast.Assign):
            return [t.id for t in node.targets if isinstance(t, ast.Name)]
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            return [node.target.id]
        return []

    def _whole(self, node: ast.stmt) -> tuple[int, int]:
        """Return the span of a statement with its decorators, its comments before, its text behind."""
        body = self.module.tree.body
        first = min([node.lineno, *[d.lineno for d in getattr(node, "decorator_list", [])]])
        lines = self.module.text.splitlines()
        while first > 1 and lines[first - 2].startswith("#"):
            first -= 1
        last = node.end_lineno or node.lineno
        at = body.index(node) + 1
        if at < len(body) and isinstance(body[at], ast.Expr) and isinstance(body[at].value, ast.Constant):
            last = body[at].end_lineno or last
        return self.module.offset(first, 0), self.module.line_starts[last]

    def _imported_names(self) -> None:
        naming, module = self.naming, self.module
        attributes = {
            id(n.value): n
            for n in ast.walk(module.tree)
            if isinstance(n, ast.Attribute) and isinstance(n.value, ast.Name)
        }
        for local, identity in naming.imported(module).items():
            if local in defined(module):
                continue
            if identity[0] == "mod":
                self._module_uses(local, identity, attributes)
                continue
            if identity[0] == "own":
                same = self.target and naming.new_of[identity[1]] == self.target.name
                final = naming.final_name(identity[1], identity[2])
                named = final if same else self._local_name(local, identity, True)
            elif self.target:
                named = naming.local.get((self.target.path, identity), local)
            else:
                named = local
            if named != local and not (identity[:2] == ("lib", "import") and "." in local):
                self._rename_uses(local, named)

    def _rename_uses(self, name: str, final: str) -> None:
        for node in self.module.names.uses.get(name, []):
            if not isinstance(node, ast.Name):
                self.problems.append(f"{self.module.path}:{node.lineno}: global {name}")  # type: ignore[attr-defined]
                continue
            if final in self.module.names.shadows[id(node)]:
                self.problems.append(
                    f"{self.module.path}:{node.lineno}: {name} -> {final}, which is local there"
                )
            start, end = self.module.span(node)
            self.edits.append((start, end, final))

    def _module_uses(self, local: str, identity: Identity, attributes: dict[int, ast.Attribute]) -> None:
        naming = self.naming
        own = self.target is not None and naming.new_of[identity[1]] == self.target.name
        named = local if own else self._local_name(local, identity, top=True)
        for node in self.module.names.uses.get(local, []):
            attribute = attributes.get(id(node))
            if attribute is None:
                if own:
                    self.problems.append(f"{self.module.path}:{node.lineno}: module {local} itself is used")  # type: ignore[attr-defined]
                elif named != local:
                    start, end = self.module.span(node)
                    self.edits.append((start, end, named))
                continue
            origin = naming.origin(identity[1], attribute.attr)
            if origin[0] != identity[1] and naming.new_of[origin[0]] != naming.new_of[identity[1]]:
                final = attribute.attr  # what that module imports stays an import of it
            else:
                final = naming.final_name(*origin)
            start, end = self.module.span(attribute)
            if own:
                if final in self.module.names.shadows[id(node)]:
                    self.problems.append(
                        f"{self.module.path}:{node.lineno}: {local}.{final} -> {final}, which is local there"  # type: ignore[attr-defined]
                    )
                self.edits.append((start, end, final))
            elif final != attribute.attr or named != local:
                self.edits.append((start, end, f"{named}.{final}"))

    # --- texts and depths ---

    def _texts(self) -> None:
        spans = [(s, e) for s, e, _ in self.edits]
        for token in tokenize.generate_tokens(io.StringIO(self.module.text).readline):
            if token.type not in (tokenize.STRING, tokenize.COMMENT):
                continue
            paths = self.module.path != "tests/conftest.py"  # its paths are those of tests
            new = renamed_text(self._roles(token.string), self.naming, paths)
            if token.type == tokenize.COMMENT or token.string.lstrip("rR").startswith('"""'):
                new = self.naming.renamed_words(new)
            if new == token.string:
                continue
            start = self._char_offset(*token.start)
            end = self._char_offset(*token.end)
            if not any(s < end and start < e for s, e in spans):
                self.edits.append((start, end, new))

    def _roles(self, text: str) -> str:
        """Return a text with the names in Sphinx roles as they will be."""
        return ROLE.sub(lambda m: f":{m[1]}:`{m[2]}{self._role_name(m[3])}`", text)

    def _role_name(self, name: str) -> str:
        naming, module = self.naming, self.module
        head, _, rest = name.partition(".")
        if name.startswith("."):
            parts = module.package.split(".") if module.package else []
            up = len(name) - len(name.lstrip("."))
            whole = ".".join([*parts[: len(parts) - (up - 1)], name.lstrip(".")])
            new = _dotted(whole, naming)
            if self.target is None or (new == whole and whole not in naming.new_of):
                return name
            return self._relative(new)
        identity = naming.imported(module).get(head)
        if head in defined(module) or (identity is not None and identity[0] == "own"):
            owner = (module.name, head) if head in defined(module) else (identity[1], identity[2])  # type: ignore[index]
            head = naming.final_name(*owner)
        return f"{head}.{rest}" if rest else head

    def _lists(self) -> None:
        """Rename what ``__all__`` lists."""
        for node in self.module.tree.body:
            if isinstance(node, ast.Assign) and any(getattr(t, "id", "") == "__all__" for t in node.targets):
                for item in ast.walk(node.value):
                    if isinstance(item, ast.Constant) and isinstance(item.value, str):
                        origin = self.naming.origin(self.module.name, item.value)
                        final = self.naming.final_name(*origin)
                        if final != item.value and not self.module.is_package:
                            self.edits.append((*self.module.span(item), f'"{final}"'))

    def _char_offset(self, line: int, column: int) -> int:
        text = self.module.text.splitlines(keepends=True)[line - 1] if column else ""
        return self.module.line_starts[line - 1] + len(text[:column].encode())

    def _depth(self) -> None:
        if self.target is None:
            return
        more = self.target.path.count("/") - self.module.path.count("/")
        for found in re.finditer(rb"__file__\)(?:\.resolve\(\))?\.parents\[(\d)\]", self.module.raw):
            if more:
                self.edits.append((found.start(1), found.end(1), str(int(found[1]) + more)))
        if b"__file__" in self.module.raw and self.target.path != self.module.path:
            self.problems.append(f"{self.module.path}: reads __file__; look at it")
        if b"__package__" in self.module.raw and self.target.path != self.module.path:
            self.problems.append(f"{self.module.path}: reads __package__; look at it")


ROLE = re.compile(r":(class|func|data|meth|exc|mod|attr|obj):`(~?)([\w.]+)`")
DOTTED = re.compile(r"\b((?:plugin|robot_bridge)(?:\.[A-Za-z_]\w*)+)")
SLASHED = re.compile(r"(?<![\w/.-])((?:plugin|robot_bridge)/[\w/.]*?\w)(\.py\b|/(?![\w*])|\b(?![\w/.]))")


def renamed_text(text: str, naming: Naming, paths: bool = True) -> str:
    """Return a text with the names and the paths of modules as they will be."""
    text = DOTTED.sub(lambda m: _dotted(m[1], naming), text)
    return SLASHED.sub(lambda m: _slashed(m, naming), text) if paths else text


def _dotted(name: str, naming: Naming) -> str:
    parts = name.split(".")
    for count in range(len(parts), 1, -1):
        head = ".".join(parts[:count])
        if head in naming.new_of:
            rest = parts[count:]
            if rest:
                rest[0] = (
                    naming.final_name(*naming.origin(head, rest[0])) if head in naming.modules else rest[0]
                )
            return ".".join([naming.new_of[head], *rest])
    return name


def _slashed(found: re.Match[str], naming: Naming) -> str:
    head, tail = found[1], found[2]
    new = naming.new_of.get(head.replace("/", "."))
    if new is None or (tail == ".py" and head.replace("/", ".") not in naming.modules):
        return found[0]
    return new.replace(".", "/") + tail


def _says(lines: list[str]) -> list[tuple[int, str, list[tuple[str, str]]]]:
    """Return what import lines bind, whatever their layout."""
    said = []
    for node in ast.parse("\n".join(lines)).body:
        names = sorted((a.name, a.asname or "") for a in node.names)  # type: ignore[attr-defined]
        said.append((getattr(node, "level", 0), getattr(node, "module", "") or "", names))
    return sorted(said)


def apply(raw: bytes, edits: list[Edit]) -> bytes:
    """Return ``raw`` with edits made, which must not overlap.

    :raises MapError: when two edits overlap.
    """
    result, at = [], 0
    for start, end, new in sorted(set(edits)):
        if start < at:
            raise MapError(f"two edits meet at byte {start}: {raw[start:end]!r} -> {new!r}")
        result += [raw[at:start], new.encode()]
        at = end
    return b"".join([*result, raw[at:]])


__all__ = ["TOPS", "Rewriter", "apply", "renamed_text"]
