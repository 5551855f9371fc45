"""DuckDB, which reads archives of trajectories."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import duckdb
import pytest


def duckdb_with_spatial() -> duckdb.DuckDBPyConnection:
    """Return DuckDB with its spatial extension; skips the test where PyPI has none."""
    found = importlib.util.find_spec("duckdb_extension_spatial")
    if found is None or found.origin is None:
        pytest.skip("duckdb-extension-spatial is not for this kind of machine")
    (file,) = Path(found.origin).parent.rglob("spatial.duckdb_extension")
    connection = duckdb.connect()
    connection.execute(f"load '{file}'")
    return connection
