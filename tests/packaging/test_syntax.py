"""A source is read although another thread parses at the same moment, as Python 3.11.2 cannot always."""

from __future__ import annotations

import ast

import pytest

from tools.syntax import TRIES, tree_of


def disturbed(times: int, monkeypatch) -> None:
    """Let the next ``times`` parsings fail as they do when another thread is parsing."""
    errors = [SystemError("AST constructor recursion depth mismatch (before=141, after=63)")] * times
    parse = ast.parse

    def parse_or_fail(source: str) -> ast.Module:
        if errors:
            raise errors.pop()
        return parse(source)

    monkeypatch.setattr(ast, "parse", parse_or_fail)


def test_a_disturbed_parsing_is_done_again(monkeypatch):
    disturbed(TRIES - 1, monkeypatch)
    assert ast.unparse(tree_of("a = 1")) == "a = 1"


def test_what_never_parses_is_told(monkeypatch):
    disturbed(TRIES, monkeypatch)
    with pytest.raises(SystemError, match="recursion depth"):
        tree_of("a = 1")


def test_what_is_no_python_is_told_at_once():
    with pytest.raises(SyntaxError):
        tree_of("a = = 1")
