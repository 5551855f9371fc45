"""Small numbers: ``make bench TRIAL=1`` runs all that a part does, in a minute, and leaves the page alone."""

from __future__ import annotations

import os
from typing import TypeVar

T = TypeVar("T")

IS_TRIAL = bool(os.environ.get("TRIAL"))


def size(full: T, trial: T) -> T:
    """Return ``full``, or ``trial`` where the parts are only tried."""
    return trial if IS_TRIAL else full
