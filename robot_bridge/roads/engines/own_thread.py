"""A thread for objects that must be made, used and let go in one and the same thread."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import Any, TypeVar

T = TypeVar("T")

Kept = dict[str, Any]
_Call = tuple["Future[Any]", Callable[..., Any], tuple[Any, ...]]
_END_WITHIN_S = 5.0


class OwnThread:
    """Does work in a thread of its own; what the work puts into ``kept`` never leaves that thread.

    The thread ends, and lets go of what it kept, when this object is let go or the program ends.
    """

    def __init__(self, name: str) -> None:
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        thread = threading.Thread(target=_serve, args=(self._calls,), name=name, daemon=True)
        thread.start()
        weakref.finalize(self, _end, self._calls, thread)

    def run(self, work: Callable[..., T], *arguments: Any) -> T:
        """Return ``work(kept, *arguments)``, done in the thread; raises what it raises."""
        done: Future[T] = Future()
        self._calls.put((done, work, arguments))
        return done.result()


def _serve(calls: SimpleQueue[_Call | None]) -> None:
    kept: Kept = {}
    while (call := calls.get()) is not None:
        done, work, arguments = call
        try:
            done.set_result(work(kept, *arguments))
        except BaseException as error:
            done.set_exception(error)
        del call, done, work, arguments


def _end(calls: SimpleQueue[_Call | None], thread: threading.Thread) -> None:
    calls.put(None)
    if threading.current_thread() is not thread:
        thread.join(_END_WITHIN_S)
