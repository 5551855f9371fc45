"""What each name of a merged module is called: no two things under one name, no thing under two."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from dataclasses import dataclass, field

from .scopes import FUNCTIONS, bindings
from .tree import MapError, Module, Plan, Target

Identity = tuple[str, ...]
"""``own`` module name, ``mod`` module, ``ext`` module name, or ``lib`` as an import writes it."""


@dataclass
class Naming:
    """``final`` names of what modules define; names of what a target imports; what is the same twice."""

    modules: dict[str, Module]
    new_of: dict[str, str]
    targets: dict[str, Target]
    plan: Plan
    final: dict[tuple[str, str], str] = field(default_factory=dict)
    local: dict[tuple[str, Identity], str] = field(default_factory=dict)
    same: dict[tuple[str, str], tuple[str, str]] = field(default_factory=dict)
    collisions: list[str] = field(default_factory=list)

    # --- what a name of a module is ---

    def imported(self, module: Module) -> dict[str, Identity]:
        """Return what the imports of a module's own level bind: the identity of each local name."""
        cache = module.__dict__.setdefault("_imported", None)
        if cache is not None:
            return cache
        found: dict[str, Identity] = {}
        for node in top_imports(module.tree.body):
            for local, identity in self.identities(module, node):
                found[local] = identity
        module.__dict__["_imported"] = found
        return found

    def identities(self, module: Module, node: ast.Import | ast.ImportFrom) -> list[tuple[str, Identity]]:
        """Return each local name that an import binds, with what it is."""
        if isinstance(node, ast.Import):
            return [(a.asname or a.name, ("lib", "import", a.name, a.asname or "")) for a in node.names]
        source = module.imported_module(node)
        result = []
        for alias in node.names:
            local = alias.asname or alias.name
            if source is None:
                result.append((local, ("lib", "." * node.level + (node.module or ""), alias.name)))
                continue
            whole = f"{source}.{alias.name}" if source else alias.name
            if whole in self.modules:
                result.append((local, ("mod", whole)))
            elif source in self.modules:
                result.append((local, ("own", *self.origin(source, alias.name))))
            else:
                result.append((local, ("lib", source, alias.name)))
        return result

    def origin(self, module: str, name: str) -> tuple[str, str]:
        """Return the module that defines ``name``, through modules that merely import it."""
        found = self.modules[module]
        if found.is_package and len(found.text.splitlines()) > 5:
            return self.same.get((module, name), (module, name))
        identity = self.imported(found).get(name)
        if identity is not None and identity[0] == "own" and name not in defined(found):
            return self.origin(identity[1], identity[2])
        return self.same.get((module, name), (module, name))

    def final_name(self, module: str, name: str) -> str:
        return self.final.get((module, name), self.plan.renames.get((module, name), name))

    def renamed_words(self, text: str) -> str:
        """Return a text with the renamed classes' names that can mean nothing else: of two words at least."""
        cache = self.__dict__.get("_words")
        if cache is None:  # FleetSupervisor is the product, too
            kept = {n for m in self.modules.values() for n in defined(m) if self.final_name(m.name, n) == n}
            words: dict[str, set[str]] = defaultdict(set)
            for (_, old), new in self.final.items():
                if (
                    old not in (new, "FleetSupervisor")
                    and re.fullmatch(r"(?:[A-Z][a-z0-9]+){2,}", old)
                    and old not in kept
                ):
                    words[old].add(new)
            cache = self.__dict__["_words"] = {o: n.pop() for o, n in words.items() if len(n) == 1}
            self.__dict__["_pattern"] = (
                re.compile(r"\b(" + "|".join(sorted(cache, key=len)) + r")\b") if cache else None
            )
        pattern = self.__dict__["_pattern"]
        return pattern.sub(lambda m: cache[m[1]], text) if pattern else text

    # --- giving names ---

    def assign(self) -> None:
        """Give every target's names, in its sources' order; what collides is renamed and listed."""
        for target in self.targets.values():
            self._assign(target)

    def _assign(self, target: Target) -> None:
        sources = [self.modules[self._name(path)] for path in target.sources]
        taken: dict[str, Identity] = {}
        builtin_uses: dict[str, set[str]] = defaultdict(set)
        for source in sources:
            for name in set(source.names.uses) - source.top:
                builtin_uses[name].add(source.name)
        own = [(s, n) for s in sources for n in in_order(s) if n in defined(s)]
        own.sort(key=lambda item: item[1].startswith("_"))
        for source, name in own:
            wanted = self.plan.renames.get((source.name, name), name)
            identity: Identity = ("own", source.name, name)
            first = taken.get(wanted)
            if first and first[0] == "own" and self._equal(first, identity):
                self.same[source.name, name] = (first[1], first[2])
                self.final[source.name, name] = wanted
                continue
            clash = first or (builtin_uses[wanted] - {source.name} and ("builtin", wanted))
            if clash:
                wanted = self._other(source, wanted, taken)
                self.collisions.append(f"{target.path}: {source.path} {name} -> {wanted} (beside {clash})")
            taken[wanted] = identity
            self.final[source.name, name] = wanted
        for source in sources:
            for local, identity in self.imported(source).items():
                if local in defined(source):
                    continue
                self._import(target, source, local, identity, taken, builtin_uses)

    def _import(
        self,
        target: Target,
        source: Module,
        local: str,
        identity: Identity,
        taken: dict[str, Identity],
        builtin_uses: dict[str, set[str]],
    ) -> None:
        key = self.placed(identity)
        if key[0] in ("own", "mod") and self.new_of[identity[1]] == target.name:
            return
        if (target.path, key) in self.local:
            return
        wanted = self.module_alias(source, local, identity) if identity[0] == "mod" else local
        if identity[0] == "own":
            final = self.final_name(identity[1], identity[2])
            wanted = final if local == identity[2] else local
        first = taken.get(wanted)
        clash = (first and first != key and first) or (
            builtin_uses[wanted] - {source.name} and ("builtin", wanted)
        )
        if clash:
            wanted = self._other(source, wanted, taken)
            self.collisions.append(
                f"{target.path}: {source.path} imports {local} as {wanted} (beside {clash})"
            )
        taken[wanted] = key
        self.local[target.path, key] = wanted

    def module_alias(self, importer: Module, local: str, identity: Identity) -> str:
        """Return the name of an imported module: its new one where it had its old one and that is free."""
        old, new = (n.rpartition(".")[2] for n in (identity[1], self.new_of[identity[1]]))
        names = importer.__dict__.get("_all_names")
        if names is None:
            nodes = list(ast.walk(importer.tree))
            names = {n.id for n in nodes if isinstance(n, ast.Name)}
            names |= {n.arg for n in nodes if isinstance(n, ast.arg)}
            names |= {a.asname or a.name for n in nodes if isinstance(n, ast.ImportFrom) for a in n.names}
            names |= {n.name for n in nodes if isinstance(n, (*FUNCTIONS, ast.ClassDef))}
            importer.__dict__["_all_names"] = names
        return new if local == old and new not in names else local

    def placed(self, identity: Identity) -> Identity:
        """Return an identity by its new place: two modules that become one are one module."""
        if identity[0] == "mod":
            return ("mod", self.new_of[identity[1]])
        return identity

    def _name(self, path: str) -> str:
        return next(m.name for m in (self._by_path()[path],))

    def _by_path(self) -> dict[str, Module]:
        cache = self.__dict__.setdefault("_paths", {m.path: m for m in self.modules.values()})
        return cache

    def _other(self, source: Module, name: str, taken: dict[str, Identity]) -> str:
        bare = name.lstrip("_")
        stem = source.stem if source.stem != "__init__" else source.name.rpartition(".")[2]
        if name.isupper() or bare.isupper():
            other = f"{stem.upper()}_{bare}"
        elif bare[0].isupper():
            other = "".join(p.title() for p in stem.split("_")) + bare
        else:
            other = f"{stem}_{bare}"
        other = "_" * (len(name) - len(bare)) + other
        while other in taken:
            other += "_"
        return other

    def _equal(self, first: Identity, second: Identity) -> bool:
        """Whether two definitions say the same with the same things."""
        one, two = self.modules[first[1]], self.modules[second[1]]
        a, b = definition(one, first[2]), definition(two, second[2])
        if a is None or b is None or ast.dump(a) != ast.dump(b):
            return False
        used = {n.id for n in ast.walk(a) if isinstance(n, ast.Name)} - {first[2]}
        return all(self._means(one, name) == self._means(two, name) for name in used)

    def _means(self, module: Module, name: str) -> Identity | None:
        if name in defined(module):
            return ("own", *self.same.get((module.name, name), (module.name, name)))
        return self.imported(module).get(name)


def top_imports(body: list[ast.stmt]) -> list[ast.Import | ast.ImportFrom]:
    """Return the imports of a module's own level, those in if, try and with included."""
    found: list[ast.Import | ast.ImportFrom] = []
    for node in body:
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            found.append(node)
        elif isinstance(node, (ast.If, ast.Try, ast.With)):
            found += top_imports([c for c in ast.walk(node) if isinstance(c, (ast.Import, ast.ImportFrom))])
    return found


def defined(module: Module) -> set[str]:
    """Return the names that a module defines itself, not by an import alone."""
    cache = module.__dict__.get("_defined")
    if cache is None:
        cache = module.__dict__["_defined"] = set(_defined(module.tree.body))
    return cache


def _defined(body: list[ast.stmt]) -> list[str]:
    kept = [n for n in body if not isinstance(n, (ast.Import, ast.ImportFrom))]
    names: list[str] = []
    for node in kept:
        if isinstance(node, (ast.If, ast.Try, ast.With)):
            imported = {
                a.asname or a.name
                for i in ast.walk(node)
                if isinstance(i, (ast.Import, ast.ImportFrom))
                for a in i.names
            }
            names += [n for n in bindings([node]) if n not in imported]
        else:
            names += list(bindings([node]))
    return names


def in_order(module: Module) -> list[str]:
    """Return what a module binds at its own level, in the order of the file, each once."""
    return list(dict.fromkeys(bindings(module.tree.body)))


def definition(module: Module, name: str) -> ast.stmt | None:
    """Return the one statement that defines ``name``, or None where there is not exactly one."""
    found = []
    for node in module.tree.body:
        if isinstance(node, (*FUNCTIONS, ast.ClassDef)) and node.name == name:
            found.append(node)
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if any(isinstance(t, ast.Name) and t.id == name for t in targets):
                found.append(node)
    return found[0] if len(found) == 1 else None


__all__ = ["Identity", "MapError", "Naming", "defined", "definition", "in_order", "top_imports"]
