"""What the operator does with a plan: send it, and agree to a new one for what is left."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QCheckBox, QGridLayout, QWidget

from ...language import first_of, tr, tr_count
from ..colours import WRONG_STYLE
from ..drafts import in_brief
from ..fixed_size import ScrollingText
from ..push_button import push_button
from .draft_plan import DraftPlan
from .driven_plan import DrivenPlan
from .plan_rows import how_made, summary


class DrivingBar(QWidget):
    """Buttons that are usable when they can do something, and a line that says how things stand."""

    send_wanted = pyqtSignal()
    override_wanted = pyqtSignal()
    leave_wanted = pyqtSignal()
    rest_wanted = pyqtSignal(bool)
    confirm_wanted = pyqtSignal()
    discard_wanted = pyqtSignal()
    resume_wanted = pyqtSignal()
    clear_wanted = pyqtSignal()
    by_itself_changed = pyqtSignal(bool)

    def __init__(self, drafts: DraftPlan, driven: DrivenPlan, parent: QWidget | None = None):
        super().__init__(parent)
        self._drafts, self._driven = drafts, driven
        self.text = ScrollingText("fleet_plan_text", lines=2)
        self.trouble = ScrollingText("fleet_plan_trouble", lines=2)
        self._make_sending_buttons()
        self._make_new_plan_buttons()
        self._make_choices()
        self._lay_out()

    def _make_sending_buttons(self) -> None:
        self.send = push_button("fleet_plan_send", tr("Send…"), pressed=self.send_wanted.emit)
        self.clear = push_button("fleet_plan_clear", tr("Clear"), pressed=self.clear_wanted.emit)
        self.override = push_button(
            "fleet_plan_override",
            tr("Override…"),
            tr("Send the plan on in spite of what was found; asks why"),
            self.override_wanted.emit,
        )
        self.leave = push_button(
            "fleet_plan_leave",
            tr("Send no more"),
            tr("Leave it at what was sent: robots that have their cones by now go on with them"),
            self.leave_wanted.emit,
        )

    def _make_new_plan_buttons(self) -> None:
        self.rest = push_button(
            "fleet_plan_rest",
            tr("Plan what is left"),
            tr(
                "Hold the robots once they have finished what they are doing, and plan what is left; "
                "nothing else is sent before you confirm"
            ),
            lambda: self.rest_wanted.emit(self.again.isChecked()),
        )
        self.confirm = push_button(
            "fleet_plan_confirm", tr("Confirm new plan"), pressed=self.confirm_wanted.emit
        )
        self.discard = push_button(
            "fleet_plan_discard", tr("Go on as before"), pressed=self.discard_wanted.emit
        )
        self.resume = push_button(
            "fleet_plan_resume",
            tr("Let them go on"),
            tr("Resume the queues of the plan's robots that somebody paused"),
            self.resume_wanted.emit,
        )

    def _make_choices(self) -> None:
        self.again = QCheckBox(tr("try failed cones again"))
        self.again.setObjectName("fleet_plan_again")
        self.by_itself = QCheckBox(tr("Send new plans without asking"))
        self.by_itself.setToolTip(
            tr("When a robot is lost or a cone fails, plan what is left and send it by itself")
        )
        self.by_itself.setObjectName("fleet_plan_by_itself")
        self.by_itself.toggled.connect(self.by_itself_changed)

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        grid.addWidget(self.text, 0, 0, 1, 2)
        grid.addWidget(self.trouble, 1, 0, 1, 2)
        # Each has a place of its own: no button comes to be where another one was pressed.
        places = (
            (self.send, self.clear),
            (self.override, self.leave),
            (self.confirm, self.discard),
            (self.rest, self.resume),
        )
        for row, parts in enumerate(places, 2):
            for column, part in enumerate(parts):
                grid.addWidget(part, row, column)
        grid.addWidget(self.again, 6, 0, 1, 2)
        grid.addWidget(self.by_itself, 7, 0, 1, 2)
        for column in range(2):
            grid.setColumnStretch(column, 1)

    def refresh(self) -> None:
        """Show how things stand now."""
        drafts, driven = self._drafts, self._driven
        idle = not driven.busy
        is_refused = driven.refusal is not None
        for button in (self.override, self.leave):
            button.setEnabled(is_refused)
        can_send = idle and not is_refused and drafts.draft is not None and driven.driven is None
        self.send.setEnabled(can_send)
        shown = driven.offer or driven.driven or drafts.draft
        self.clear.setEnabled(idle and not is_refused and shown is not None and not driven.held)
        watching = driven.driven is not None and not driven.progress.is_finished(driven.driven.plan)
        self.rest.setEnabled(idle and watching and driven.offer is None)
        self.again.setEnabled(watching and bool(driven.trouble.failed))
        self.confirm.setEnabled(idle and driven.offer is not None)
        self.discard.setEnabled(bool(driven.held) and driven.sending is None)
        self.resume.setEnabled(idle and watching and driven.offer is None and bool(driven.paused))
        told = self._in_words()
        self.text.setText(told)
        self.text.setToolTip("\n".join([told, *([] if shown is None else [how_made(shown)])]))
        self.trouble.setText(self._wrong())
        self.trouble.set_text_style(WRONG_STYLE if self.trouble.text() else "")

    def _in_words(self) -> str:
        drafts, driven = self._drafts, self._driven
        if driven.refusal is not None:
            return tr("Not sent as a whole yet")
        if driven.sending is not None:
            return tr("Being sent …")
        if driven.offer is not None:
            return tr("New plan, not sent yet: {summary}", summary=summary(driven.offer))
        if driven.driven is not None and driven.progress is not None:
            done, all_of_them = len(driven.progress.done), len(driven.driven.plan.targets)
            if driven.progress.is_finished(driven.driven.plan):
                return tr_count(all_of_them, "Done: {done} of 1 cone", "Done: {done} of %n cones", done=done)
            under_way = tr_count(
                all_of_them, "Under way: {done} of 1 cone", "Under way: {done} of %n cones", done=done
            )
            return ". ".join([under_way, *driven.pauses_in_words()])
        if drafts.draft is not None:
            return tr("Not sent yet: {summary}", summary=summary(drafts.draft))
        return tr("No plan. Choose cones and robots, then Preview or Solve.")

    def _wrong(self) -> str:
        driven = self._driven
        if driven.refusal is not None:
            hint = tr(" Override… sends it all the same, where your role may.")
            return f"{driven.refusal.words}: {in_brief(driven.refusal.found)}{hint}"
        shown = driven.offer or driven.driven or self._drafts.draft
        near = shown.meetings if shown is not None and (driven.driven is None or driven.offer) else ()
        parts = first_of([meeting.in_words() for meeting in near])
        if shown is not None and (driven.driven is None or driven.offer):
            parts = [*first_of([one.in_words() for one in shown.closed]), *parts]
        if driven.trouble and driven.offer is None:
            parts.insert(0, driven.trouble.in_words())
        return "; ".join(parts)
