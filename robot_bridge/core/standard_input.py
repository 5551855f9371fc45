"""End of standard input: whoever started a program holds its other side, and is gone when it closes."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable

_STDIN = 0


def call_at_end_of_input(called: Callable[[], object]) -> None:
    """Have the running event loop call ``called`` once standard input, a pipe, is closed at its other side.

    That happens however the program at that side ended, also when it was killed.
    """
    loop = asyncio.get_running_loop()

    def read() -> None:
        if not os.read(_STDIN, 4096):
            loop.remove_reader(_STDIN)
            called()

    loop.add_reader(_STDIN, read)
