"""Tries a connection: greets the gateway, says what became of it, and hangs up."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ..connection import Connection
from ..errors import FleetError
from ..language import tr
from ..wire.addresses import Credentials
from ..wire.status import LinkStatus, Phase

LOOK_EVERY_MS = 50


class ConnectionTrial(QObject):
    """One trial at a time. The network is waited for in a thread; :meth:`end` waits for that thread."""

    told = pyqtSignal(bool, str)
    """Whether the gateway let the operator in, and what to say of it."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._connection = Connection(self)
        self._site = None
        self._timer = QTimer(self)
        self._timer.setInterval(LOOK_EVERY_MS)
        self._timer.timeout.connect(self._look)

    def begin(self, url: str, operator: str, credentials: Credentials) -> None:
        """Try to connect; a trial that is under way is given up."""
        self._site = None
        try:
            self._connection.open(url, operator, credentials)
        except FleetError as error:
            self.told.emit(False, str(error))
            return
        self._timer.start()

    def end(self) -> None:
        """Give up what is under way."""
        self._timer.stop()
        self._connection.shut_down()

    def _look(self) -> None:
        news = self._connection.take()
        self._site = news.site or self._site
        if not self._connection.is_open:
            # The thread of a trial that is over ends within a moment: it is looked after until then.
            if not self._connection.is_ending:
                self._timer.stop()
            return
        verdict = self._verdict(news.link)
        if verdict is not None:
            self._connection.close()
            self.told.emit(*verdict)

    def _verdict(self, link: LinkStatus) -> tuple[bool, str] | None:
        if link.phase in (Phase.RETRYING, Phase.FAILED):
            return False, link.reason
        if link.phase is Phase.CONNECTED and self._site is not None:
            site = {"site": self._site.name, "crs": self._site.crs}
            if link.who:
                return True, tr("{site} ({crs}) answers, as {who}.", who=link.who, **site)
            return True, tr("{site} ({crs}) answers.", **site)
        return None
