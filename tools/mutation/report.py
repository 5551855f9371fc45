"""The page's part on mutants: how many of each module died, and why each of the others may live."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.page import Part, goal
from tools.mutation.findings import Fate, Mutant
from tools.mutation.reasons import Reasons

GOAL = 0.95
DIED = (Fate.TYPES, Fate.KILLED, Fate.TIMED_OUT)
LIVES = (Fate.SURVIVED, Fate.UNREACHED)
HEADS = ["module", "mutants", "refused by mypy", "killed by a test", "no end", "live, with a reason"]
HEADS += ["live, without", "not tried", "died", "died of those that mypy takes"]
TEXT = """\
[mutmut](https://mutmut.readthedocs.io) changes what stops robots and follows their commands: one operator,
argument or value at a time, properties included. Each change is tried with the tests named in
`pyproject.toml` that run its function: quick ones, on SQLite, without servers and without QGIS. A change dies
when mypy refuses it, when a test fails, or when a test comes to no end. What lives has a reason in
`tools/mutation/survivors.toml`, or has none. Shares are of the mutants that were tried. Values of modules,
and what has a decorator other than `property`, are not changed.

{table}

Of those tried {died:.1f} % died ({goal}).

{survivors}
"""


def part_of(mutants: Sequence[Mutant], reasons: Reasons) -> Part:
    """Return the page's part; it has failed where fewer died than are to."""
    modules = sorted({mutant.module for mutant in mutants})
    rows = [_row(f"`{name}`", [one for one in mutants if one.module == name], reasons) for name in modules]
    rows.append(_row("all", mutants, reasons))
    heads = [f"| {' | '.join(HEADS)} |", f"|{' --- |' * len(HEADS)}"]
    untried = sum(one.fate is Fate.UNTRIED for one in mutants)
    if untried:
        rows.append(f"\n**The run was stopped before {untried} of {len(mutants)} were tried.**")
    died = share_of_dead(mutants)
    text = TEXT.format(
        table="\n".join([*heads, *rows]),
        died=100 * died,
        goal=goal(f"at least {100 * GOAL:g} %", died >= GOAL),
        survivors=_survivors(mutants, reasons),
    )
    is_short = died < GOAL or any(one.fate is Fate.UNTRIED for one in mutants)
    return Part("Mutants", text, is_short, "make mutants")


def share_of_dead(mutants: Sequence[Mutant]) -> float:
    """Return the share of the mutants tried that died, 1 where there are none."""
    tried = [one for one in mutants if one.fate is not Fate.UNTRIED]
    return sum(one.fate in DIED for one in tried) / len(tried) if tried else 1.0


def _row(name: str, mutants: Sequence[Mutant], reasons: Reasons) -> str:
    def count(fate: Fate) -> int:
        return sum(one.fate is fate for one in mutants)

    alive = [one for one in mutants if one.fate in LIVES]
    explained = sum(reasons.of(one) is not None for one in alive)
    tried = [one for one in mutants if one.fate is not Fate.TYPES]
    numbers = [len(mutants), *map(count, DIED), explained, len(alive) - explained, count(Fate.UNTRIED)]
    shares = [_percent(some) for some in (mutants, tried)]
    return f"| {name} | {' | '.join(map(str, numbers))} | {' | '.join(shares)} |"


def _percent(mutants: Sequence[Mutant]) -> str:
    if all(one.fate is Fate.UNTRIED for one in mutants):
        return "–"
    return f"{100 * share_of_dead(mutants):.1f} %"


def _survivors(mutants: Sequence[Mutant], reasons: Reasons) -> str:
    by_reason: dict[str, list[Mutant]] = {}
    for one in mutants:
        if one.fate in LIVES:
            by_reason.setdefault(reasons.of(one) or "", []).append(one)
    told = [
        _group(reason or "Without a reason", found)
        for reason, found in sorted(by_reason.items(), reverse=True)
    ]
    return "\n\n".join(["What lives:", *told]) if told else "None lives."


def _group(reason: str, mutants: Sequence[Mutant]) -> str:
    lines = [f"  - `{one.module}` {one.function}: {_change(one)}" for one in mutants]
    return "\n".join([f"- {reason} ({len(mutants)}):", *lines])


def _change(mutant: Mutant) -> str:
    """Return the change with as much beside it as tells what it is."""
    was, becomes = mutant.was, mutant.becomes
    begin = _common(was, becomes)
    end = min(_common(was[::-1], becomes[::-1]), min(len(was), len(becomes)) - begin)
    first, last = max(0, begin - 30), 20
    old = was[first : len(was) - end + min(end, last)]
    new = becomes[first : len(becomes) - end + min(end, last)]
    return f"`` {old} `` → `` {new} ``"


def _common(one: str, other: str) -> int:
    return next(
        (n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other))
    )
