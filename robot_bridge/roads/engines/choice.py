"""The fastest engine that runs here."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from ..centrelines import Floats
from ..errors import MissingEngineError
from .contraction import ContractionEngines
from .engine import Engine, Graph
from .plain import PlainEngine
from .scipy_engine import scipy_engines

Engines = Callable[[Floats], Engine]
"""Makes an engine on one graph from the cost of each arc."""

AUTOMATIC = "automatic"

_MAKERS: dict[str, tuple[str, str, Callable[[Graph], Engines]]] = {
    "contraction": ("routingkit_cch", "routingkit-cch", ContractionEngines),
    "scipy": ("scipy", "scipy", scipy_engines),
    "plain": ("heapq", "", lambda graph: lambda costs: PlainEngine(graph, costs)),
}
"""Of each engine the module that it needs, the package that has it, and how engines are made."""

ENGINES = (AUTOMATIC, *_MAKERS)


def engines_for(graph: Graph, name: str = AUTOMATIC) -> Engines:
    """Return the maker of engines ``name``; of AUTOMATIC the fastest one that runs here.

    :raises MissingEngineError: when ``name`` is none, or its package is not installed.
    """
    if name not in ENGINES:
        raise MissingEngineError(f"There is no engine {name!r} for routes: choose of {', '.join(ENGINES)}.")
    if not len(graph.tail):
        # There is no way to find, and RoutingKit ends the process on a graph without arcs.
        return lambda costs: PlainEngine(graph, costs)
    if name == AUTOMATIC:
        return _fastest(graph)
    module, package, maker = _MAKERS[name]
    try:
        return maker(graph)
    except ImportError as error:
        raise MissingEngineError(
            f"The engine {name!r} for routes needs {module}, which does not load here ({error}): "
            f"install it with 'pip install {package}', or choose another of {', '.join(ENGINES)}."
        ) from error


def _fastest(graph: Graph) -> Engines:
    for _, _, maker in _MAKERS.values():
        with contextlib.suppress(ImportError):
            return maker(graph)
    raise AssertionError("the plain engine needs nothing")
