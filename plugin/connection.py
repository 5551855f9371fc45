"""The connection to the gateway: one worker thread, out of the window's way."""

from __future__ import annotations

import asyncio
import threading

from qgis.PyQt.QtCore import QObject, QThread

from .errors import NotSentError
from .language import tr
from .websocket_library import websocket_library
from .wire.addresses import Credentials, check_address
from .wire.client import DeskClient
from .wire.mailbox import Mailbox, News
from .wire.outbox import Order
from .wire.status import LinkStatus, Phase

STOP_WITHIN_MS = 3000
CANCEL_WITHIN = 0.3


class Connection(QObject):
    """The link to a gateway as the window sees it. No method waits for the network.

    Nothing is signalled message by message: a timer of the window calls :meth:`take`.
    """

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._worker: _Worker | None = None
        self._ending: list[_Worker] = []
        self._mailbox = Mailbox()
        self.rate = 10.0
        """How many times a second positions are asked for at most, by links that are opened from now on."""

    @property
    def is_open(self) -> bool:
        """Whether a link is wanted, be it up or not."""
        return self._worker is not None

    @property
    def is_ending(self) -> bool:
        """Whether a link that was given up still has its thread."""
        return bool(self._ending)

    def open(self, url: str, operator: str, credentials: Credentials | None = None) -> None:
        """Connect to the gateway at ``url`` and stay connected until :meth:`close`.

        :raises AddressError: when the URL cannot be a gateway's, or the token or the CA file not be used.
        :raises LibraryMissingError: when there is no WebSocket library.
        """
        url = check_address(url)
        credentials = credentials or Credentials()
        credentials.check(url)
        library = websocket_library()
        self.close()
        self._mailbox = Mailbox()
        self._mailbox.put_link(LinkStatus(Phase.CONNECTING))
        client = DeskClient(url, operator, self._mailbox, library, self.rate, credentials)
        self._worker = _Worker(client, self._mailbox)
        self._worker.start()

    def close(self) -> None:
        """Give up the link; its thread ends by itself within a moment."""
        if self._worker is None:
            return
        self._worker.ask_to_stop()
        self._ending.append(self._worker)
        self._worker = None
        self._forget_ended()

    def submit(self, order: Order) -> None:
        """Hand an order to the worker thread.

        :raises NotSentError: when no link is wanted.
        """
        if self._worker is None or not self._worker.submit(order):
            raise NotSentError(tr("The desk is not connected to a gateway. Press Connect first."))

    def take(self) -> News:
        """Return what arrived since the last call."""
        self._forget_ended()
        news = self._mailbox.take()
        if self._worker is None:
            # The worker that is ending may still have said that it will try again.
            news.link = LinkStatus(Phase.CLOSED)
        return news

    def shut_down(self) -> None:
        """Close the link and wait until every thread has ended."""
        self.close()
        for worker in self._ending:
            worker.wait(STOP_WITHIN_MS)
        self._forget_ended()

    def _forget_ended(self) -> None:
        self._ending = [worker for worker in self._ending if not worker.isFinished()]


class _Worker(QThread):
    """Runs one client's event loop."""

    def __init__(self, client: DeskClient, mailbox: Mailbox):
        super().__init__()
        self.setObjectName("fleet_connection")
        self._client = client
        self._mailbox = mailbox
        self._lock = threading.Lock()
        self._early: list[Order] = []
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task | None = None
        self._stopping = False

    def submit(self, order: Order) -> bool:
        """Hand ``order`` to the client; false when the worker has ended or is about to."""
        with self._lock:
            if self._stopping:
                return False
            if self._loop is None:
                self._early.append(order)
            else:
                self._loop.call_soon_threadsafe(self._client.submit, order)
            return True

    def ask_to_stop(self) -> None:
        """Make the event loop end, from any thread."""
        with self._lock:
            self._stopping = True
            if self._loop is not None and self._task is not None:
                self._loop.call_soon_threadsafe(self._task.cancel)

    def run(self) -> None:
        # An exception that leaves QThread.run ends the process outside QGIS and is lost inside it.
        try:
            self._run_loop()
        except Exception as error:
            self._mailbox.put_link(
                LinkStatus(
                    Phase.FAILED,
                    tr(
                        "The connection stopped on an internal fault ({name}: {error}). Press Connect to "
                        "try again and report this text.",
                        name=type(error).__name__,
                        error=error,
                    ),
                )
            )

    def _run_loop(self) -> None:
        loop = asyncio.new_event_loop()
        try:
            with self._lock:
                if self._stopping:
                    return
                self._loop, self._task = loop, loop.create_task(self._client.run())
                for order in self._early:
                    self._client.submit(order)
            loop.run_until_complete(self._task)
        except asyncio.CancelledError:
            return
        finally:
            with self._lock:
                self._stopping, self._loop, self._task = True, None, None
            _end_tasks(loop)
            loop.close()


def _end_tasks(loop: asyncio.AbstractEventLoop) -> None:
    """Cancel what a library left running, such as the pings of a link that would not close."""
    left = asyncio.all_tasks(loop)
    for task in left:
        task.cancel()
    if left:
        loop.run_until_complete(asyncio.wait(left, timeout=CANCEL_WITHIN))
    # A link that was cut off closes its socket in the loop's next round, and there would be none.
    loop.run_until_complete(asyncio.sleep(0))
