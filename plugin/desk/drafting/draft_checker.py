"""Has the draft on the map checked while the window lives on, and says when it may be sent."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...errors import FleetError
from ..drafts import Draft, DraftBoard, Findings
from ..time_slices import Steps, TimeSlices

Work = Callable[[Draft, bool], Steps[Draft]]
"""Takes a draft, and whether all of it is to be looked at afresh; returns the draft with what was found."""


class DraftChecker(QObject):
    """Checks the draft on ``board``, and no other.

    What was found is for the one draft that was looked at: a draft is never changed, only replaced, and with
    another one on the board nothing comes of the check that was under way. What was to follow it is passed on
    with ``displaced`` where another draft was begun.
    """

    progressed = pyqtSignal()
    """A check has begun, gone on, or come to its end."""
    overtaken = pyqtSignal(object)
    """The draft was changed before something could be done with it: the Draft as it was."""
    displaced = pyqtSignal(object, object)
    """Another draft was begun before something could be done with this one: the Draft, and what to do."""
    found = pyqtSignal(object)
    """The draft that was put on the map has been looked at: the Draft, with its findings."""

    def __init__(self, board: DraftBoard, work: Work, parent: QObject | None = None):
        super().__init__(parent)
        self._board = board
        self.work = work
        self._slices = TimeSlices(self)
        self._draft: Draft | None = None
        self._afresh = self._is_put = False
        self._then: Callable[[Draft], None] | None = None
        self._anew = QTimer(self)
        self._anew.setSingleShot(True)
        self._anew.setInterval(0)
        self._anew.timeout.connect(self._begin_anew)
        board.changed.connect(self._changed)

    @property
    def is_under_way(self) -> bool:
        """Whether the draft on the board is being looked at."""
        return self._draft is not None

    @property
    def has_order(self) -> bool:
        """Whether something is to be done with the draft once it has been looked at."""
        return self._then is not None

    @property
    def share(self) -> float:
        """How much of the check is done, 0 to 1."""
        return self._slices.share

    def put(self, draft: Draft) -> None:
        """Make ``draft`` the one on the board; a small one has been checked when this returns.

        :raises FleetError: when it cannot be checked; what was on the board stays then.
        """
        self._put(draft, self._board.put)

    def amend(self, draft: Draft) -> None:
        """Put ``draft`` in place of the one on the board, whose way is another by now; check it as by put.

        :raises FleetError: as :meth:`put`.
        """
        self._put(draft, self._board.renew)

    def _put(self, draft: Draft, place: Callable[[Draft], None]) -> None:
        before, ordered = (self._draft, self._afresh, self._is_put, self._then), self._ordered
        self._draft, self._afresh, self._is_put, self._then = draft, False, True, None
        try:
            checked = self._begin()
        except FleetError:
            self._draft, self._afresh, self._is_put, self._then = before
            self._anew.start()
            raise
        self._draft = draft if checked is None else checked
        place(self._draft)
        if checked is not None:
            self._end(checked)
        if ordered is not None:
            # To take changes back must not lead to what is on its way out.
            self._board.forget_changes()
            self.displaced.emit(ordered, before[3])
        self.progressed.emit()

    def again(self, then: Callable[[Draft], None]) -> None:
        """Look at the draft on the board afresh, then do something with it unless it is another by then.

        :raises FleetError: when it cannot be checked; nothing is done then.
        """
        self._draft, self._afresh, self._is_put, self._then = self._board.draft, True, False, then
        try:
            checked = self._begin()
        except FleetError:
            self._give_up()
            raise
        if checked is not None:
            self._take(checked)
        self.progressed.emit()

    def withdraw(self) -> bool:
        """Do nothing with the draft after the check; false where nothing was to be done."""
        had_order, self._then = self.has_order, None
        if had_order:
            self.progressed.emit()
        return had_order

    def begin_anew(self) -> None:
        """Give up what was found so far: a layer has changed under it."""
        if self._draft is not None:
            self._slices.stop()
            # A layer that is changed feature by feature tells of each.
            self._anew.start()

    def stop(self) -> None:
        """Look at nothing any more."""
        self._give_up()

    def _changed(self) -> None:
        draft = self._board.draft
        if draft is self._draft:
            return
        # Who takes a draft away needs not be told that it is not sent.
        ordered = self._ordered if draft is not None else None
        self._give_up()
        self._tell_of(ordered)
        if draft is not None and not draft.is_checked and not self._board.is_dragged:
            # Taken back to one whose check was not finished.
            self._draft = draft
            self._anew.start()
        self.progressed.emit()

    @property
    def _ordered(self) -> Draft | None:
        return self._draft if self.has_order else None

    def _tell_of(self, ordered: Draft | None) -> None:
        if ordered is not None:
            self.overtaken.emit(ordered)

    def _begin(self) -> Draft | None:
        self._anew.stop()
        work = self.work(self._draft, self._afresh)
        return self._slices.begin(work, self.progressed.emit, self._take, self._failed)

    def _begin_anew(self) -> None:
        if self._draft is None:
            return
        try:
            checked = self._begin()
        except FleetError as error:
            self._failed(error)
            return
        if checked is not None:
            self._take(checked)

    def _failed(self, error: FleetError) -> None:
        self._take(replace(self._draft, findings=Findings(refused=(str(error),)), is_checked=True))

    def _take(self, checked: Draft) -> None:
        """Put what was found into the draft on the board."""
        if checked != self._draft:
            # From here on it is this one that is looked at.
            self._draft = checked
            self._board.renew(checked)
        self._end(checked)
        self.progressed.emit()

    def _end(self, checked: Draft) -> None:
        then, is_put = self._then, self._is_put
        self._give_up()
        if is_put:
            self.found.emit(checked)
        if then is not None:
            then(checked)

    def _give_up(self) -> None:
        self._anew.stop()
        self._slices.stop()
        self._draft, self._then = None, None
        self._afresh = self._is_put = False
