"""Files of tests that a worker reads in when their turn comes: the outcome is as if all had been read in."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

FILES = {
    "conftest.py": """
import pytest
from tests.support import file_by_file

def pytest_configure(config):
    file_by_file.begin(config, lambda files: files.sort(key=lambda one: one.path))

@pytest.fixture(scope="session")
def opened():
    yield (lines := [])
    print("the session ends with", *lines)
""",
    "a/test_first.py": """
import pytest

@pytest.fixture(scope="module")
def module(opened):
    opened.append("opened")
    yield
    opened.append("closed")

@pytest.mark.parametrize("number", [1, 2, 3])
def test_it(module, number):
    assert number != 2
""",
    "a/test_left_out.py": "def test_unwanted(): raise AssertionError\n",
    "b/test_broken.py": "import no_such_module\n",
    "b/test_last.py": """
import sys

def test_the_file_before_has_ended(opened):
    assert opened == ["opened", "closed"]

def test_the_next_is_not_read_in_yet():
    assert not [name for name in sys.modules if "test_unread" in name]
""",
    "c/test_unread.py": "def test_it(): pass\n",
}


@pytest.fixture
def run(root, tmp_path):
    """Run tests in a worker: ``run(*arguments)`` returns the exit code, and what it printed."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --import-mode=importlib\n", encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-p", "xdist.plugin", "-p", "no:cacheprovider", "-rA"]
    command += ["-n", "1", "--dist", "loadfile", "--no-loadscope-reorder"]
    environment = {**os.environ, "PYTHONPATH": str(root), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}

    def run(*arguments):
        done = subprocess.run(
            [*command, *arguments], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        return done.returncode, done.stdout + done.stderr

    return run


def test_each_test_asked_for_is_run_once_and_what_is_wrong_is_said(run):
    code, printed = run("-k", "test_it or has_ended or not_read_in")
    assert code == 1, printed
    assert re.search(r"= 1 failed, 5 passed, 1 error in ", printed), printed
    assert "FAILED a/test_first.py::test_it[2]" in printed
    assert "ERROR b/test_broken.py" in printed and "No module named 'no_such_module'" in printed
    assert "[100%]" in printed


def test_it_ends_at_the_first_failure_where_that_is_asked_for(run):
    code, printed = run("-x")
    assert code in (1, 2), printed
    assert re.search(r"= 1 failed, 1 passed in ", printed), printed


def test_one_test_is_found_by_its_name(run):
    code, printed = run("a/test_first.py::test_it[1]")
    assert code == 0 and re.search(r"= 1 passed in ", printed), printed


def test_a_selection_of_nothing_is_an_error_as_ever(run):
    code, printed = run("-k", "no_such_test", "a")
    assert code == pytest.ExitCode.NO_TESTS_COLLECTED, printed


@pytest.mark.parametrize("missing", ["a/test_gone.py", "a/test_gone.py::test_it"])
def test_a_file_that_is_not_there_is_named(run, missing):
    code, printed = run("a/test_first.py", missing)
    assert code == pytest.ExitCode.USAGE_ERROR, printed
    assert f"file or directory not found: {missing}" in printed
