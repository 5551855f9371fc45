"""Tables of the desk as CSV files."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from datetime import datetime
from pathlib import Path

from ..errors import FleetError
from ..language import tr

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


class CsvError(FleetError):
    """A table was not written."""


def write_csv(path: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> int:
    """Write a table as UTF-8 that spreadsheets open as such, and return how many rows it has.

    Nothing takes the place of an older file before the new one is complete.

    :raises CsvError: when the file cannot be written.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text)
    table.writerow(head)
    count = 0
    for row in rows:
        table.writerow([_cell(value) for value in row])
        count += 1
    target = Path(path)
    part = target.with_name(target.name + ".part")
    try:
        part.write_text(text.getvalue(), encoding="utf-8-sig", newline="")
        part.replace(target)
    except OSError as error:
        raise CsvError(
            tr(
                "{file} was not written ({why}). Choose another folder, or close the file where it is open.",
                file=target,
                why=error.strerror or error,
            )
        ) from error
    return count


def iso_time(at: float | None) -> str:
    """Return a time since 1970 as ISO 8601 in the computer's time zone; nothing for none."""
    if at is None:
        return ""
    return datetime.fromtimestamp(at).astimezone().isoformat(timespec="milliseconds")


def _cell(value: object) -> object:
    # A spreadsheet would run a text such as =cmd() that came over the wire.
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return "" if value is None else value
