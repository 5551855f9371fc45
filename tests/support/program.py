"""How a program of the stage ends: with its exit status, and what went wrong in one line."""

from __future__ import annotations

import sys
from collections.abc import Callable

from tests.support.errors import StageError
from tests.support.processes import leave_on_signals


def ended(name: str, work: Callable[[], object], where_to_look: str = "") -> int:
    """Do the ``work`` of the program ``name`` and return its exit status.

    An error of the stage is printed with ``where_to_look`` for more. SIGTERM and a closed terminal end the
    work the way an exception does, so that what it started is ended.
    """
    leave_on_signals()
    try:
        work()
    except StageError as error:
        more = f"\n({where_to_look})" if where_to_look else ""
        print(f"{name}: error: {error}{more}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0
