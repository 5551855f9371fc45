"""What docs/benchmarks.md says comes out of the run: no template of a part has a figure typed into it."""

from __future__ import annotations

import ast
import importlib.util
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.appliance import Pictures, Setting, Use, subscriptions
from benchmarks.appliance import Run as SmallRun
from benchmarks.appliance import report as small_report
from benchmarks.clock import spread
from benchmarks.endurance_findings import Run, Sample, Unloaded
from benchmarks.endurance_page import report
from benchmarks.limits import LimitError, Throttling, small_computer
from benchmarks.page import Beginning, Part, goal, with_part
from tests.support.patience import BUSY

ROOT = Path(__file__).resolve().parents[2]
INSTANCE = "e_n51_k5.py"
"""Numbers of a public instance, which are not said but computed with."""
MODULES = [
    ROOT / "tools" / "mutation" / "report.py",
    *(path for path in sorted((ROOT / "benchmarks").glob("*.py")) if path.name != INSTANCE),
]
PRODUCT = {"plugin", "robot_bridge"}
PROGRAMS = sorted(
    path for part in ("benchmarks", "tests/support", "tools") for path in (ROOT / part).rglob("*.py")
)
PLACEHOLDER, CODE = re.compile(r"\{[^{}]*\}"), re.compile(r"`[^`]*`")
NAMES = re.compile(r"E-n51-k5|\bext4\b|\b1969\b|\bcodec \d|\bp\d\d\b|EPSG:\d+|10\*\*|ROS 2|VDA 5050|\bNav2\b")
"""What has a digit and is no figure: a public instance and its year, formats, percentiles, standards."""
UNIT = r"(?:ms|s|min|h|Hz|[kKMG]i?B|bytes|m|cm|mm|km|%|×|times|(?:milli)?seconds?|minutes?|hours?)"
FIGURE = re.compile(rf"(?<![\w.])\d[\d .,]*\s?{UNIT}(?![\w/])")
WORD = r"(?:two|three|four|five|six|seven|eight|nine|ten|twenty|thirty|forty|fifty|hundred|thousand|half an?)"
IN_WORDS = re.compile(
    rf"\b{WORD} (?:milliseconds|seconds?|minutes?|hours?|MB|percent|times a second)\b", re.I
)


def test_what_programs_import_of_the_product_exists():
    """A benchmark or a walk that nobody runs in the suite would break at a renaming without a word."""
    missing = [
        f"{path.relative_to(ROOT)}: from {module} import {name}"
        for path in PROGRAMS
        for module, name in imported_names(path)
        if not hasattr(importlib.import_module(module), name) and not is_module(f"{module}.{name}")
    ]
    assert missing == [], "\n" + "\n".join(missing)


def imported_names(path: Path) -> Iterator[tuple[str, str]]:
    """Yield module and name of what a program imports from the product, wherever in it."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in PRODUCT:
            yield from ((node.module, alias.name) for alias in node.names)


def is_module(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def test_no_template_has_a_figure_typed_into_it():
    found = [f"{path.name}: {text}" for path in MODULES for text in typed_figures(path.read_text("utf-8"))]
    assert found == [], "\n" + "\n".join(found)


@pytest.mark.parametrize(
    "text",
    [
        "the process goes from {a} MB to 39 MB of it",
        "They took 0.5 s each.",
        "delivered at 147 % of a core",
        "it is 2.5 times as fast",
        "looked at every ten seconds",
        "5 000 obstacles",
    ],
)
def test_a_typed_figure_is_found(text):
    assert list(typed_figures(f'TEXT = """\\\nOne line.\n{text}\n"""'))


def test_what_comes_from_the_run_is_no_typed_figure():
    text = "{took:.1f} ms in `2 s`, the p99 of codec 2 on E-n51-k5; the last two rows, {a[0]:+.0f} MB."
    assert list(typed_figures(f'TEXT = """\\\nOne line.\n{text}\n"""')) == []


def test_a_typed_figure_in_a_sentence_is_found():
    assert list(typed_figures("def told(a):\n    '''In 2 s.'''\n    return f'{a} within 0.1 m of it'"))
    assert (
        list(typed_figures("def told(a):\n    '''In 2 s.'''\n    return f'{a} within {NEAR} m of it'")) == []
    )


def typed_figures(source: str) -> Iterator[str]:
    """Yield what of a module's texts is a figure that was typed.

    In a template, which is a text of several lines that a name of the module stands for, that is every digit
    that is no part of a name; elsewhere a number with its unit.
    """
    tree = ast.parse(source)
    templates = {id(node.value) for node in tree.body if isinstance(node, ast.Assign) and is_template(node)}
    for node, text in texts_of(tree):
        said = NAMES.sub("", CODE.sub("", PLACEHOLDER.sub("", text)))
        pattern = re.compile(r"\d") if id(node) in templates else FIGURE
        yield from (around(said, match) for match in [*pattern.finditer(said), *IN_WORDS.finditer(said)])


def is_template(node: ast.Assign) -> bool:
    text = node.value.value if isinstance(node.value, ast.Constant) else ""
    return isinstance(text, str) and "\n" in text and not text.lstrip().startswith(("import ", "["))


def texts_of(tree: ast.Module) -> Iterator[tuple[ast.expr, str]]:
    """Yield every string that is no docstring, an f-string with what it puts in as placeholders."""
    inside: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):
            inside.add(id(node.value))
        elif isinstance(node, ast.JoinedStr):
            inside |= {id(part) for part in ast.walk(node)} - {id(node)}
            yield node, "".join(one.value if isinstance(one, ast.Constant) else "{}" for one in node.values)
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in inside:
            yield node, node.value


def around(text: str, match: re.Match[str]) -> str:
    return " ".join(text[max(0, match.start() - 30) : match.end() + 30].split())


def test_a_part_says_what_it_ran_under(monkeypatch):
    monkeypatch.setenv("MALLOC_ARENA_MAX", "2")
    table = "| " + " | ".join(["a long cell that no line may break"] * 5) + " |\n| --- |"
    part = Part("Maps", f"A paragraph.\n\n{table}", settings={"GDAL_CACHEMAX": "16"})
    page = with_part("", "maps", part, ["maps"], Beginning.now())
    git = ["git", "-C", str(ROOT), "rev-parse", "--short=8", "HEAD"]
    commit = subprocess.run(git, capture_output=True, text=True).stdout.strip()
    assert f"Made by `make bench PARTS=maps`{f' of commit {commit}' if commit else ''}" in page
    words = " ".join(page.split())
    assert "load of the machine in the minute before it began" in words
    assert "`GDAL_CACHEMAX=16`" in words and "`MALLOC_ARENA_MAX=2`" in words
    assert table in page
    again = with_part(page, "maps", part, ["maps"], Beginning.now())
    assert again.count("## Maps") == 1


def test_a_goal_that_is_missed_is_marked():
    assert goal("at most 3 ms", True) == "goal: at most 3 ms, met"
    assert goal("at most 3 ms", False) == "goal: at most 3 ms, **missed**"


def test_a_median_is_told_with_its_spread():
    assert f"{spread([3.0, 1.0, 2.0]):.1f}" == "2.0 [1.0–3.0]"
    assert f"{spread(map(float, range(101))):.0f}" == "50 [25–75]", "of many the quartiles"


def test_a_shift_that_is_too_large_misses_its_goal():
    samples = [Sample(10.0 * k, 500.0 + k, 200.0, 100.0 + k, 16.0, 0, 0, 10, 2, 24, 0) for k in range(180)]
    end = {"told": {}, "seconds": 1800.0, "longer": {"0.01": 3}, "work_at": {}, "gaps_at": {}, "worst": []}
    run = Run(samples, [Unloaded([], 100.0, 16.0, 600_000)] * 2, end, {"reset": 3}, [])
    text = report(run, 30.0, [], robots=10, raster_cache=16, window=(800, 600))
    assert "goal: at most 60 MB more, **missed**" in text and "looked at every 10 s" in " ".join(text.split())


def test_a_small_computer_holds_what_runs_on_it():
    busy = "import time; end = time.monotonic() + 0.4\nwhile time.monotonic() < end: pass"
    limits = {"cores": 0.2, "megabytes": 200, "cpus": "0"}
    try:
        with small_computer(f"fleet-test-{os.getpid()}", ("busy", "idle"), **limits) as (whole, parts):
            began = time.monotonic()
            # Beside others it gets little of its share at first, and is not held back from more.
            while whole.throttling().throttled <= 5 or whole.throttling().seconds <= 0.1:
                assert time.monotonic() - began < 10 * BUSY, whole.throttling()
                subprocess.run([*parts["busy"].through, sys.executable, "-c", busy], check=True)
            passed = time.monotonic() - began
            used = {name: part.cpu_seconds() for name, part in parts.items()}
            assert used["idle"] == 0.0 and used["busy"] <= whole.cpu_seconds() < 0.1 + 0.2 * passed
            assert whole.killed() == 0 and whole.megabytes() < 200
            too_much = [*parts["idle"].through, sys.executable, "-c", "bytearray(300_000_000)"]
            assert subprocess.run(too_much).returncode == -signal.SIGKILL
            assert max(parts["idle"].killed(), whole.killed()) == 1
    except LimitError as error:
        pytest.skip(str(error))
    assert not list(Path("/sys/fs/cgroup").rglob(f"fleet-test-{os.getpid()}"))


def test_what_panel_and_page_subscribe_to_is_found_in_their_sources():
    desk, phone, rates, budget = subscriptions()
    assert desk["rate"] > phone["rate"] == max(rates) > min(rates) > 0
    assert phone["form"] == "columns" and budget > 100_000


def test_a_stop_that_some_robot_never_heard_of_misses_its_goal():
    seen = {"positions": 150.0, "late": 3.0, "stops": [20.0, float("nan")], "answers": [9.0]}
    desk = subscriptions().desk
    seen |= {
        who: {"delays": [10.0, 30.0, 20.0], "bytes": 1000.0, "subscription": desk}
        for who in ("desk", "phone")
    }
    use = Use(0.5, 100.0, Throttling(100, 7, 0.1))
    parts = dict.fromkeys(("gateway", "database", "maps"), use)
    run = SmallRun(Setting("SQLite", None), seen, Pictures([300.0]), parts, use, 500.0, 0)
    part = small_report("Small", [run])
    assert part.failed and "**never**" in part.text and "**missed**" in part.text
    seen["stops"] = [20.0, 30.0]
    assert not small_report("Small", [run]).failed
    run.killed = 1
    assert small_report("Small", [run]).failed
