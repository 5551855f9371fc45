"""Files that strangers hand on: what they cost goes by their length, and what is wrong is named."""

from __future__ import annotations

import gzip
import time
from pathlib import Path

import pytest
from sqlalchemy import make_url

from robot_bridge.core.assignment.plan import plan_from_json
from robot_bridge.core.errors import ConeTableError, PlanFileError, SettingsError, StoreError
from robot_bridge.core.json_decoder import toml_tables
from robot_bridge.core.layouts.cone_files import ConeColumns, cones_of, read_csv
from robot_bridge.core.sites.settings import read_settings
from robot_bridge.core.sites.settings_tables import value_text
from robot_bridge.gateway.storage.backup import MARK, PostgreSqlBackups
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.base.settings import read_settings as read_link_settings
from robot_bridge.links.tracker.adapter import TrackerSettings

MOST = 3.0
"""seconds of the processor, on a computer three times as slow as a common one."""


@pytest.fixture(autouse=True)
def cheap():
    began = time.process_time()
    yield
    assert time.process_time() - began < MOST


@pytest.mark.parametrize(
    "text",
    [
        "a" + ".a" * 120_000 + " = 1",
        "[" + "a." * 100_000 + "a]",
        'x = {"a"' + ".'a'" * 60_000 + " = 1}",
        "x = " + "[" * 200_000,
        "x = " + "{a=" * 80_000,
        "x = " + "1" * 200_000,
        "a = 1\n" * 1_000_000,
    ],
)
def test_toml_that_is_deep_or_long_is_refused(text, tmp_path):
    with pytest.raises(ValueError):
        toml_tables(text)
    (tmp_path / "site.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError, match=r"site\.toml is not valid TOML: .+ Correct that line"):
        read_settings(tmp_path / "site.toml")
    with pytest.raises(LinkError, match=r"site\.toml (is not valid TOML|has more than)"):
        read_link_settings(tmp_path / "site.toml", "tracker", TrackerSettings)


def test_keys_of_some_parts_are_read():
    assert toml_tables('[a.b."c.d"]\ne.f = 1') == {"a": {"b": {"c.d": {"e": {"f": 1}}}}}
    assert toml_tables(f'x = "{"a b. " * 100}"')


@pytest.mark.parametrize("line", ['"' * 1 + '\\"' * 100_000, "[" + " " * 200_000, "k = " + '["\\"' * 60_000])
def test_lines_of_a_settings_text_are_gone_over_once(line):
    assert value_text(f"[site]\n{line}\nname = 'Yard'\n", "site", "name") in ("'Yard'", None)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("," * 400_000 + "\n" + "1\n" * 300_000, "400001 columns, more than 1000"),
        ("," * 900 + "\n" + "1\n" * 400_000, "row 2: it has not as many columns"),
        ("x_m,y_m\n" + "1,1\n" * 250_000, "more than 100000 rows"),
        ("x_m,y_m\n" + '"' * 900_000, "cannot be read"),
        ("x_m,y_m\n1," + "9" * 120_000 + "\n", "is no number"),
    ],
)
def test_a_table_of_cones_without_bounds_is_refused(tmp_path, text, reason):
    file = tmp_path / "cones.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConeTableError, match=reason):
        head, rows = read_csv(file)
        cones_of(rows, head, ConeColumns(), "cones")


@pytest.mark.parametrize("text", ["[" * 1_000_000, '{"a":' * 200_000, "9" * 1_000_000, '"' + "\\n" * 500_000])
def test_a_plan_that_is_deep_or_long_is_refused(text):
    with pytest.raises(PlanFileError):
        plan_from_json(text)


@pytest.mark.parametrize("first", [MARK + b"[" * 4000, b"[" * 4000 + b"\n", MARK + b"{}"])
def test_the_first_line_of_a_backup_is_not_believed(tmp_path: Path, first: bytes):
    file = tmp_path / "backup"
    file.write_bytes(gzip.compress(first + bytes(50_000_000)))
    with pytest.raises(StoreError, match="backup"):
        PostgreSqlBackups(make_url("postgresql://robots@127.0.0.1/robots")).check(file)
