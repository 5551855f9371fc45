"""What plugins.qgis.org runs on the zip finds nothing; `make check-plugin` runs all of it on every file.

Here each program looks at as much as a test has time for: bandit at what ruff, which has most of its rules
and is a hundred times as fast, points to; detect-secrets at all but Python. What flake8 looks for ruff does,
too (test_style.py).
"""

from __future__ import annotations

import configparser
import json
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tools.package import build
from tools.plugin_checks import by_bandit, by_detect_secrets, by_flake8

LINKS = {
    "repository": "https://code.fleet-supervisor.invalid/plugin",
    "tracker": "https://code.fleet-supervisor.invalid/plugin/issues",
}
REQUIRED = {"name", "description", "version", "qgisMinimumVersion", "author", "email", "about", *LINKS}
TEXTS = {".md", ".toml", ".js", ".html", ".txt", ".qml"}


def test_bandit_finds_nothing(unpacked):
    ruff = [Path(sys.executable).with_name("ruff"), "check", "--isolated", "--no-cache", "--ignore-noqa"]
    ruff += ["--select=S", "--ignore=S101", "--exclude=vendor", "--output-format=json", unpacked]
    pointed_to = json.loads(subprocess.run(ruff, capture_output=True, text=True, check=False).stdout)
    files = {Path(one["filename"]).resolve() for one in pointed_to}
    assert len(files) > 15
    assert list(map(str, by_bandit(unpacked.resolve(), sorted(files)))) == []


@pytest.mark.again("make check-plugin, before each upload")
def test_detect_secrets_finds_nothing_in_texts(unpacked):
    texts = [file for file in unpacked.rglob("*") if file.suffix in TEXTS]
    assert len(texts) > 40
    assert list(map(str, by_detect_secrets(unpacked, texts))) == []


@pytest.mark.parametrize(
    ("check", "text", "rule"),
    [
        (by_bandit, "import os\nos.system(input())\n", "B605"),
        (by_detect_secrets, 'password = "hunter2hunter"\n', "Secret Keyword"),
        (by_flake8, "def f():\n    return unknown\n", "F821"),
    ],
)
def test_what_is_wrong_is_found(tmp_path, check, text, rule):
    for folder in ("fleet/plugin", "fleet/plugin/vendor"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "a.py").write_text(text, encoding="utf-8")
    found = [str(one) for one in check(tmp_path) if "vendor" not in one.file]
    assert len(found) == 1
    assert found[0].startswith("fleet/plugin/a.py:") and rule in found[0]


def test_what_others_wrote_is_excluded_there_as_here(unpacked):
    settings = configparser.ConfigParser()
    settings.read(unpacked / "fleet_supervisor" / ".bandit", encoding="utf-8")
    assert dict(settings["bandit"]) == {"exclude": "/plugin/vendor/"}


def test_the_metadata_is_read_as_it_is_read_there(tmp_path):
    """With interpolation: a lone % would be refused."""
    metadata = configparser.ConfigParser()
    metadata.optionxform = str
    with zipfile.ZipFile(build(tmp_path, LINKS)) as archive:
        metadata.read_string(archive.read("fleet_supervisor/metadata.txt").decode())
    given = dict(metadata.items("general"))
    assert set(given) >= REQUIRED and all(given[key].strip() for key in REQUIRED)
    assert "/" not in given["author"]
    assert "supportsQt6" not in given
