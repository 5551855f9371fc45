"""Python source as a tree, also while other threads run."""

from __future__ import annotations

import ast

TRIES = 20


def tree_of(source: str) -> ast.Module:
    """Return the tree of ``source``.

    Up to Python 3.11.4 two threads that parse at once disturb each other, and one gets a SystemError (CPython
    issue 106905). Every thread that prints an exception parses, to put the carets under it.

    :raises SyntaxError: when ``source`` is no Python.
    """
    for _ in range(TRIES - 1):
        try:
            return ast.parse(source)
        except SystemError:
            continue
    return ast.parse(source)
