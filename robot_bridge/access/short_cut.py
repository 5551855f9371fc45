"""The way of short messages past the queue of a connection."""

from __future__ import annotations

from collections.abc import Callable

from .buckets import Bucket
from .frame_edges import FrameEdges, short_text

END_OF_REQUEST = b"\r\n\r\n"


class ShortCut:
    """Deals with the messages that need no waiting as soon as their bytes are there.

    The parsing, the queue and the tasks that this saves take several times as long as a position does. Only
    what nothing is on the long way before goes here: messages are dealt with in the order they were sent.
    ``handler`` deals with a message, or returns false and has done nothing.
    """

    def __init__(self) -> None:
        self.handler: Callable[[bytes], bool] | None = None
        self.on_the_long_way = 0
        self._edges: FrameEdges | None = None

    def begin(self, request: bytes) -> None:
        """Follow the frames from the end of the request on, whose last bytes these are."""
        # Where something came behind the request it is not known where the next frame begins.
        if request.find(END_OF_REQUEST) == len(request) - len(END_OF_REQUEST):
            self._edges = FrameEdges()

    def take(self, data: bytes, messages: Bucket) -> int:
        """Deal with the messages at the beginning of ``data``, each one of ``messages``.

        Return where that begins which has to go the long way; :meth:`pass_over` is to be called with it.
        """
        start, edges = 0, self._edges
        if self.handler is None or edges is None or not edges.between or self.on_the_long_way:
            return 0
        while (found := short_text(data, start)) is not None and messages.take():
            message, end = found
            if not self.handler(message):
                messages.give_back()
                break
            start = end
        return start

    def pass_over(self, data: bytes) -> None:
        """Take note of bytes that go the long way."""
        if self._edges is not None:
            self._edges.pass_over(data)
