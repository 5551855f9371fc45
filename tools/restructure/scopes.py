"""Which names of a Python module mean its globals: scope by scope, as the compiler resolves them."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


@dataclass
class Scope:
    """One scope: ``bound`` are its own names, ``kind`` is module, class, function or comprehension."""

    kind: str
    bound: set[str] = field(default_factory=set)
    parent: Scope | None = None

    def finds(self, name: str) -> Scope | None:
        """Return the scope that ``name`` means when it is used here; None for builtins."""
        if name in self.bound:
            return self
        scope = self.parent
        while scope is not None:
            if name in scope.bound and scope.kind != "class":
                return scope
            scope = scope.parent
        return None


class GlobalNames:
    """The uses of global and of builtin names in a module.

    ``uses[name]`` are the nodes (Name, or Global statements) that mean the global ``name``, or a builtin;
    ``shadows[id(node)]`` is the set of names that local scopes around a node bind.
    """

    def __init__(self, tree: ast.Module):
        self.uses: dict[str, list[ast.AST]] = defaultdict(list)
        self.shadows: dict[int, set[str]] = {}
        self.module = Scope("module", set(bindings(tree.body)))
        for statement in tree.body:
            self._visit(statement, self.module)

    def _visit(self, node: ast.AST, scope: Scope) -> None:
        if isinstance(node, ast.Name):
            self._use(node.id, node, scope)
        elif isinstance(node, FUNCTIONS):
            self._function(node, scope)
        elif isinstance(node, ast.Lambda):
            inner = Scope("function", set(argument_names(node.args)), scope)
            self._visit_all([*node.args.defaults, *[d for d in node.args.kw_defaults if d]], scope)
            self._visit(node.body, inner)
        elif isinstance(node, ast.ClassDef):
            self._visit_all([*node.decorator_list, *node.bases, *node.keywords], scope)
            inner = Scope("class", set(bindings(node.body)), scope)
            self._visit_all(node.body, inner)
        elif isinstance(node, COMPREHENSIONS):
            self._comprehension(node, scope)
        elif isinstance(node, ast.Global):
            for name in node.names:
                self.uses[name].append(node)
        else:
            self._visit_all(ast.iter_child_nodes(node), scope)

    def _visit_all(self, nodes: Iterable[ast.AST], scope: Scope) -> None:
        for node in nodes:
            self._visit(node, scope)

    def _use(self, name: str, node: ast.AST, scope: Scope) -> None:
        found = scope.finds(name)
        if found is None or found.kind == "module":
            self.uses[name].append(node)
            self.shadows[id(node)] = local_names(scope)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, scope: Scope) -> None:
        arguments = node.args
        self._visit_all([*node.decorator_list, *arguments.defaults], scope)
        self._visit_all([d for d in arguments.kw_defaults if d], scope)
        self._visit_all([a.annotation for a in all_arguments(arguments) if a.annotation], scope)
        if node.returns:
            self._visit(node.returns, scope)
        declared = {n for g in walk_own(node.body) if isinstance(g, ast.Global) for n in g.names}
        bound = set(argument_names(arguments)) | set(bindings(node.body))
        nonlocals = {n for g in walk_own(node.body) if isinstance(g, ast.Nonlocal) for n in g.names}
        self._visit_all(node.body, Scope("function", bound - declared - nonlocals, scope))

    def _comprehension(self, node: ast.AST, scope: Scope) -> None:
        generators = node.generators  # type: ignore[attr-defined]
        inner = Scope("comprehension", {n for g in generators for n in target_names(g.target)}, scope)
        for index, generator in enumerate(generators):
            self._visit(generator.iter, inner if index else scope)
            self._visit(generator.target, inner)
            self._visit_all(generator.ifs, inner)
        parts = [getattr(node, name, None) for name in ("elt", "key", "value")]
        self._visit_all([part for part in parts if part is not None], inner)


def local_names(scope: Scope | None) -> set[str]:
    """Return all names that ``scope`` and the scopes around it, the module's excepted, bind."""
    names: set[str] = set()
    while scope is not None and scope.kind != "module":
        names |= scope.bound
        scope = scope.parent
    return names


def all_arguments(arguments: ast.arguments) -> list[ast.arg]:
    """Return every argument of a function, in any way that it can be passed."""
    rest = [a for a in (arguments.vararg, arguments.kwarg) if a]
    return [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs, *rest]


def argument_names(arguments: ast.arguments) -> list[str]:
    """Return the names of every argument."""
    return [a.arg for a in all_arguments(arguments)]


def walk_own(body: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """Walk through a body without what has a scope of its own: functions and classes are not entered."""
    for node in body:
        yield node
        if isinstance(node, (*FUNCTIONS, ast.ClassDef, ast.Lambda)):
            continue
        if isinstance(node, COMPREHENSIONS):
            yield from (inner for inner in ast.walk(node) if isinstance(inner, ast.NamedExpr))
            continue
        yield from walk_own(ast.iter_child_nodes(node))


def target_names(target: ast.AST) -> Iterator[str]:
    """Return the names that an assignment to ``target`` binds."""
    for node in ast.walk(target):
        if isinstance(node, ast.Name):
            yield node.id


def bindings(body: Iterable[ast.AST]) -> Iterator[str]:
    """Return the names that a body binds in its own scope."""
    for node in walk_own(body):
        if isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            yield node.name
        elif isinstance(node, ast.Name) and isinstance(node.ctx, (ast.Store, ast.Del)):
            yield node.id
        elif isinstance(node, ast.NamedExpr):
            yield node.target.id
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            yield from (a.asname or a.name.split(".")[0] for a in node.names)
        elif (isinstance(node, ast.ExceptHandler) and node.name) or (
            isinstance(node, (ast.MatchAs, ast.MatchStar)) and node.name
        ):
            yield node.name
        elif isinstance(node, ast.MatchMapping) and node.rest:
            yield node.rest
