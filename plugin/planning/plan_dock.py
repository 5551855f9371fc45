"""The panel of cone plans: computed, edited, sent and followed; its menu entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QMessageBox,
    QProgressBar,
    QSizePolicy,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.plans import PlanProblemKind, PlanReport, PlanState
from ...robot_bridge.core.messages.records import MOST_PLACEMENTS, CollectLayout, GetPlacements
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_REQUEST, Level
from ..control.pending_command import in_brief
from ..map.live_view import LiveView
from ..panel.pending_command_panel import OverrideDialog
from ..ui.actions import ActionDock, DockAction
from ..ui.dialogs import ShrinkableScrollArea, confirm, push_button
from ..ui.errors import FleetError
from ..ui.glyphs import WRONG_STYLE
from ..ui.language import first_of, plain_tip, tr, tr_count
from ..ui.steady_widgets import ScrollingText
from . import plan_texts
from .as_placed import AsPlacedPage
from .execution import PlanExecution, no_plans_here
from .forms import RobotsForm, SettingsForm
from .plan_editor import CollectionPlanner, PlanEditor
from .plan_settings import PlanSettings, keep_settings, read_settings
from .plan_texts import ReportedProgress
from .plan_views import PlanLayers, PlanTree
from .proposal import closed_in_words, meeting_in_words

# --- Actions on a plan: sending it, and accepting a new one for the remainder ---


class ExecutionBar(QWidget):
    """Buttons that are enabled when they have an effect, and a line with the status."""

    send_plan_requested = pyqtSignal()
    override_requested = pyqtSignal()
    pause_requested = pyqtSignal()
    rest_requested = pyqtSignal(bool)
    confirm_requested = pyqtSignal()
    discard_requested = pyqtSignal()
    resume_requested = pyqtSignal()
    clear_requested = pyqtSignal()
    by_itself_changed = pyqtSignal(bool)

    def __init__(self, drafts: PlanEditor, driven: PlanExecution, parent: QWidget | None = None):
        super().__init__(parent)
        self._drafts, self._driven = drafts, driven
        self.text = ScrollingText("fleet_plan_text", lines=2)
        self.trouble = ScrollingText("fleet_plan_trouble", lines=2)
        self._make_sending_buttons()
        self._make_new_plan_buttons()
        self._make_choices()
        self._lay_out()

    def _make_sending_buttons(self) -> None:
        self.send = push_button("fleet_plan_send", tr("Send…"), pressed=self.send_plan_requested.emit)
        self.clear = push_button(
            "fleet_plan_clear",
            tr("Clear"),
            tr("Follow the plan no more, at no desk; robots go on with their queues"),
            self.clear_requested.emit,
        )
        self.override = push_button(
            "fleet_plan_override",
            tr("Override…"),
            tr("Send the plan in spite of what was found; asks why"),
            self.override_requested.emit,
        )
        self.pause = push_button(
            "fleet_plan_pause",
            tr("Pause the plan"),
            tr("Send the plan's robots no further task; what they are doing they finish"),
            self.pause_requested.emit,
        )

    def _make_new_plan_buttons(self) -> None:
        self.rest = push_button(
            "fleet_plan_rest",
            tr("Plan what is left"),
            tr(
                "Hold the robots once they have finished what they are doing, and plan what is left; "
                "nothing else is sent before you confirm"
            ),
            lambda: self.rest_requested.emit(self.again.isChecked()),
        )
        self.confirm = push_button(
            "fleet_plan_confirm", tr("Confirm new plan"), pressed=self.confirm_requested.emit
        )
        self.discard = push_button(
            "fleet_plan_discard", tr("Go on as before"), pressed=self.discard_requested.emit
        )
        self.resume = push_button(
            "fleet_plan_resume",
            tr("Let them go on"),
            tr("Resume the queues of the plan's robots that somebody paused"),
            self.resume_requested.emit,
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
        # Each has its own place: no button moves to where another one was pressed.
        places = (
            (self.send, self.clear),
            (self.override, self.pause),
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
        """Show the current status."""
        drafts, driven = self._drafts, self._driven
        known = driven.known
        report = None if known is None else known.report
        self._enable_for_draft() if report is None else self._enable_for(report)
        self.override.setEnabled(not driven.asking and driven.refusal is not None)
        self.by_itself.blockSignals(True)
        self.by_itself.setChecked(drafts.settings.by_itself if report is None else report.by_itself)
        self.by_itself.blockSignals(False)
        self.by_itself.setEnabled(report is None)
        text, shown = self._in_words(report), driven.shown_plan
        self.text.setText(text)
        method = [] if shown is None else [plan_texts.method_text(shown)]
        self.text.setToolTip(plain_tip("\n".join([text, *method])))
        self.trouble.setText(self._wrong(report))
        self.trouble.set_text_style(WRONG_STYLE if self.trouble.text() else "")

    def _enable_for_draft(self) -> None:
        can = not self._driven.busy and self._drafts.draft is not None
        for button in (self.send, self.clear):
            button.setEnabled(can)
        for button in (self.pause, self.rest, self.again, self.confirm, self.discard, self.resume):
            button.setEnabled(False)

    def _enable_for(self, report: PlanReport) -> None:
        driven, state = self._driven, report.state
        idle = not driven.asking
        has_rest = state in (PlanState.REPLANNING, PlanState.PROPOSED)
        goes_on = state in (PlanState.DRIVEN, PlanState.PAUSED)
        self.send.setEnabled(False)
        self.clear.setEnabled(idle and not has_rest)
        self.pause.setEnabled(goes_on or has_rest)
        self.rest.setEnabled(idle and goes_on)
        failed = any(one.kind is PlanProblemKind.FAILED for one in report.problems)
        self.again.setEnabled(goes_on and failed)
        is_seen = driven.known.proposal is not None and driven.known.is_whole
        self.confirm.setEnabled(idle and state is PlanState.PROPOSED and is_seen)
        self.discard.setEnabled(idle and has_rest)
        self.resume.setEnabled(idle and goes_on and bool(state is PlanState.PAUSED or driven.paused))

    def _in_words(self, report: PlanReport | None) -> str:
        driven = self._driven
        if driven.asking:
            return tr("Being sent …")
        if report is None:
            draft = self._drafts.draft
            if draft is None:
                return tr("No plan. Choose cones and robots, then Preview or Solve.")
            return tr("Not sent yet: {summary}", summary=plan_texts.plan_summary(draft.plan))
        if report.state is PlanState.REPLANNING:
            return tr("What is left is being planned …")
        if report.state is PlanState.PROPOSED and driven.known.proposal is not None:
            return tr(
                "New plan, not sent yet: {summary}", summary=plan_texts.plan_summary(driven.known.proposal)
            )
        count, done = report.cones, report.done
        if report.state is PlanState.FINISHED:
            return tr_count(count, "Done: {done} of 1 cone", "Done: {done} of %n cones", done=done)
        under_way = tr_count(count, "Under way: {done} of 1 cone", "Under way: {done} of %n cones", done=done)
        return ". ".join([under_way, *driven.pauses_in_words()])

    def _wrong(self, report: PlanReport | None) -> str:
        driven, draft = self._driven, self._drafts.draft
        if driven.refusal is not None:
            hint = tr(" Override… sends it all the same, where your role may.")
            return f"{driven.refusal.words}: {in_brief(driven.refusal.found)}{hint}"
        if report is None:
            if driven.is_without_plans:
                return no_plans_here()
            closed, meetings = ((), ()) if draft is None else (draft.closed, draft.meetings)
            return "; ".join(
                [
                    *first_of([closed_in_words(one) for one in closed]),
                    *first_of([meeting_in_words(one) for one in meetings]),
                ]
            )
        if report.state is PlanState.PROPOSED:
            return "; ".join(_against(report))
        return plan_texts.problem_in_words(report.problems)


def _against(report: PlanReport) -> list[str]:
    """Return the findings against the new plan for the remainder."""
    texts = []
    if report.closed:
        texts.append(
            tr_count(report.closed, "1 way leads along a closed road", "%n ways lead along closed roads")
        )
    if report.meetings:
        texts.append(
            tr_count(
                report.meetings,
                "robots come too near to one another at 1 place",
                "robots come too near to one another at %n places",
            )
        )
    return texts


# --- The panel of cone plans: made, reviewed, edited, sent, followed; and the as-placed report ---


class PlanDock(ActionDock):
    """Builds the parts. :meth:`remove` undoes what they did outside of it."""

    place_requested = pyqtSignal(float, float)
    """The place of a cone or of a stop, metres in the site frame."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(tr("Cone plan"), "fleet_plan_dock", parent)
        self._desk = desk
        desk.state.plans_changed.connect(self._build_for)

    def _build_for(self, plans: list[str]) -> None:
        # A driven plan is on the map and its problems are reported, even if the panel is closed.
        if plans:
            self.build()

    def _build(self) -> None:
        desk = self._desk
        self.drafts = PlanEditor(desk, self)
        self.driven = PlanExecution(desk, self.drafts, self)
        self.collecting = CollectionPlanner(desk, self.drafts, self)
        self.layers = PlanLayers(desk)
        self.form = SettingsForm(desk.project, self.drafts.settings)
        # The form has chosen the existing layer of cones, where the project's settings name none.
        self.drafts.plan_with(self.form.settings(self.drafts.settings))
        self.robots = RobotsForm()
        self.tree = PlanTree()
        self.bar = ExecutionBar(self.drafts, self.driven)
        self.which = QComboBox()
        self.which.setObjectName("fleet_plan_which")
        self.which.setToolTip(tr("A new plan, or one that the gateway drives, whoever submitted it"))
        self.which.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.placed = AsPlacedPage(desk)
        self.preview = push_button("fleet_plan_preview", tr("Preview"), tr("A quick plan, to look at"))
        self.solve = push_button(
            "fleet_plan_solve", tr("Solve"), tr("A good plan, within the time that is given")
        )
        self.cancel = push_button("fleet_plan_cancel", tr("Cancel"), tr("Give up what is being planned"))
        self.progress = QProgressBar()
        self._turn = desk.beat.turn()
        self.question: QMessageBox | None = None
        self._generation = desk.state.robots.generation
        self._lay_out()
        self._wire()
        self._refresh()

    def _remove_parts(self) -> None:
        """Cancel planning and remove the layers from the project."""
        self.drafts.shut_down()
        self._desk.project.readProject.disconnect(self._read_settings)
        self.form.remove()
        self.layers.remove()

    # --- Actions of the operator ---

    def make(self, *, preview: bool) -> None:
        """Plan the chosen cones, unless a plan is being driven."""
        self._desk.messages.end(PLAN_REQUEST)
        if not self._make_room():
            return
        try:
            self.drafts.make(preview=preview)
        except FleetError as error:
            self._refuse(str(error))

    def _make_room(self) -> bool:
        try:
            self.driven.make_room()
        except FleetError as error:
            self._desk.messages.post(str(error), Level.WARNING, PLAN_REQUEST)
            return False
        return True

    def ask_to_send(self) -> None:
        """Show the consequences, and send when the operator agrees."""
        draft = self.drafts.draft
        if draft is None:
            return
        text = plan_texts.before_sending(self._desk, draft)
        send = "fleet_plan_question_send", tr("Send")
        box = confirm(
            self, "fleet_plan_question", text, send, tr("Do not send"), lambda: self._try(self.driven.send)
        )
        box.setWindowTitle(tr("Send the cone plan"))
        self.question = box
        box.open()

    def ask_to_override(self) -> None:
        """Ask for a reason to override a refusal of the plan, and send it with that."""
        refusal = self.driven.refusal
        if refusal is None:
            return
        then = tr("The plan is sent at once, and robots set off.")
        dialog = OverrideDialog(refusal.words, refusal.found, then, self, is_safe=True)
        dialog.confirmed.connect(lambda why: self._try(lambda: self.driven.override(refusal, why)))
        dialog.open()

    def collect(self, layout: str | None, only: frozenset[int] | None = None) -> None:
        """Plan the collection of a layout, or of all standing cones, unless a plan is being driven.

        Of these ``only`` the placed cones of these numbers are collected, where that is not None.
        """
        if self._make_room():
            self._try(lambda: self.collecting.ask(CollectLayout(layout), only))

    # --- Display ---

    def _refresh(self) -> None:
        driven = self.driven
        known, shown = driven.known, driven.shown_plan
        progress = None if known is None else ReportedProgress(known.report, self._desk.state.placed_cones)
        rows = {} if shown is None else plan_texts.stop_rows(shown, progress)
        began_at = None if progress is None else progress.began_at
        self.tree.show_plan(shown, rows, began_at, editable=known is None and not driven.busy)
        self.layers.show(shown, rows)
        self._show_choice()
        self.bar.refresh()
        self.placed.show_plan(None, None) if known is None else self.placed.show_plan(
            known.plan, known.report.cones
        )
        for button in (self.preview, self.solve):
            button.setEnabled(not driven.busy)
        self.cancel.setEnabled(self.drafts.busy)
        if not self.drafts.busy:
            self.progress.reset()
        self.progress.setEnabled(self.drafts.busy)

    def _show_choice(self) -> None:
        """List the plans to choose from, with the present one selected."""
        entries = [(tr("New plan"), None)]
        entries += [(plan_texts.plan_title(one.report), one.plan) for one in self.driven.choice]
        box = self.which
        if entries != [(box.itemText(k), box.itemData(k)) for k in range(box.count())]:
            box.clear()
            for text, name in entries:
                box.addItem(text, name)
        known = self.driven.known
        box.setCurrentIndex([name for _, name in entries].index(None if known is None else known.plan))
        box.setEnabled(len(entries) > 1 and not self.driven.asking)

    def _placements_changed(self) -> None:
        if self.driven.known is not None:
            self._refresh()
        if self._desk.state.placed_cones and self.isVisible():
            self.placed.show_placed()

    def _show_placed_layer(self) -> None:
        if self.placed.isVisible():
            self.layers.show_placed(self.placed.placements)

    def _pulled(self) -> None:
        if self.isVisible() and self._turn.is_due():
            self._show_robots()
        if self.drafts.task is not None:
            self.progress.setValue(round(100.0 * self.drafts.task.share))

    def _shown(self, is_visible: bool) -> None:
        if is_visible:
            self._show_robots()
            # Cones that were placed while it was closed.
            self._placements_changed()

    def _show_robots(self) -> None:
        self.robots.show_robots(self._desk, self.drafts.settings)

    def _keep(self, settings: PlanSettings) -> None:
        if settings != self.drafts.settings:
            self.drafts.plan_with(settings)
            keep_settings(self._desk.project, settings)

    def _read_settings(self, *_: object) -> None:
        self.drafts.plan_with(read_settings(self._desk.project))
        self.form.show_settings(self.drafts.settings)
        self.bar.refresh()

    def _set_by_itself(self, on: bool) -> None:
        self.drafts.plan_with(replace(self.drafts.settings, by_itself=on))

    def _site_changed(self) -> None:
        """Drop what belongs to other robots; a site that was published again keeps its plan."""
        if self._generation != self._desk.state.robots.generation:
            self._generation = self._desk.state.robots.generation
            self._desk.messages.end(PLAN_REQUEST)
            self.driven.forget()

    def _ask_for_placements(self) -> None:
        self._try(lambda: self._desk.orders.ask(GetPlacements(limit=MOST_PLACEMENTS), tr("Placed cones")))

    def _refuse(self, why: str) -> None:
        """Report why an action on a plan was not done; shown until the next request."""
        self._desk.report_failure(why, PLAN_REQUEST)

    def _try(self, action: Callable[[], object]) -> None:
        self._desk.messages.end(PLAN_REQUEST)
        try:
            action()
        except FleetError as error:
            self._refuse(str(error))

    # --- Layout ---

    def _lay_out(self) -> None:
        plan = QWidget()
        rows = QVBoxLayout(plan)
        rows.setContentsMargins(0, 4, 0, 0)
        rows.setSpacing(5)
        self.form.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        rows.addWidget(self.form)
        rows.addWidget(self.robots)
        buttons = QHBoxLayout()
        for button in (self.preview, self.solve, self.cancel):
            buttons.addWidget(button)
        rows.addLayout(buttons)
        line = QHBoxLayout()
        line.addWidget(self.which, 2)
        line.addWidget(self.progress, 1)
        rows.addLayout(line)
        rows.addWidget(self.tree, 1)
        rows.addWidget(self.bar)
        self.tabs = QTabWidget()
        self.tabs.setObjectName("fleet_plan_tabs")
        # The tabs are outside of the scrolled area: they are always visible.
        self.tabs.addTab(ShrinkableScrollArea(plan), tr("Plan"))
        self.tabs.addTab(self.placed, tr("As placed"))
        body = QWidget()
        outer = QVBoxLayout(body)
        outer.setContentsMargins(8, 6, 8, 8)
        outer.addWidget(self.tabs)
        self.tree.setMinimumHeight(100)
        self.setWidget(body)
        self.setFocusProxy(self.form.cones)

    def _wire(self) -> None:
        desk, bar = self._desk, self.bar
        self.form.changed.connect(lambda: self._keep(self.form.settings(self.drafts.settings)))
        self.robots.edited.connect(lambda name, one: self._keep(self.drafts.settings.with_robot(name, one)))
        self.robots.refused.connect(desk.warning)
        self.preview.clicked.connect(lambda: self.make(preview=True))
        self.solve.clicked.connect(lambda: self.make(preview=False))
        self.cancel.clicked.connect(self.drafts.cancel)
        self.tree.move_requested.connect(lambda *where: self._try(lambda: self.drafts.move(*where)))
        self.tree.remove_requested.connect(lambda target: self._try(lambda: self.drafts.remove(target)))
        self.tree.place_requested.connect(self.place_requested)
        self.placed.place_requested.connect(self.place_requested)
        bar.send_plan_requested.connect(self.ask_to_send)
        bar.clear_requested.connect(lambda: self._try(self.driven.clear))
        bar.override_requested.connect(self.ask_to_override)
        bar.pause_requested.connect(lambda: self._try(self.driven.pause))
        self.which.activated.connect(lambda index: self.driven.choose(self.which.itemData(index)))
        bar.rest_requested.connect(lambda again: self._try(lambda: self.driven.plan_rest(try_again=again)))
        bar.confirm_requested.connect(lambda: self._try(self.driven.confirm))
        bar.discard_requested.connect(lambda: self._try(self.driven.discard))
        bar.resume_requested.connect(lambda: self._try(self.driven.resume))
        bar.by_itself_changed.connect(self._set_by_itself)
        self.drafts.changed.connect(self._refresh)
        self.driven.changed.connect(self._refresh)
        self.drafts.refused.connect(self._refuse)
        self.driven.hint.connect(desk.hint)
        self.collecting.refused.connect(lambda text: desk.messages.post(text, Level.WARNING, PLAN_REQUEST))
        self.placed.refresh_requested.connect(self._ask_for_placements)
        self.placed.collect_requested.connect(self.collect)
        self.placed.shown.connect(self._show_placed_layer)
        self.placed.layer_requested.connect(self.layers.placed.finish)
        desk.state.placed_cones_changed.connect(self._placements_changed)
        desk.state.updated.connect(self._pulled)
        self.visibilityChanged.connect(self._shown)
        desk.state.site_changed.connect(self._site_changed)
        desk.project.readProject.connect(self._read_settings)


# --- The menu entry that shows the panel of cone plans ---


class PlansAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: FleetController, view: LiveView):
        dock = PlanDock(desk, iface.mainWindow())
        dock.place_requested.connect(view.show_place)
        super().__init__(
            iface,
            menu,
            dock,
            icon="assign_cones.svg",
            text=tr("Cone plan"),
            name="fleet_plan_panel",
            tip=tr("Plan which robot places or collects which cone, send it, watch it; the as-placed report"),
        )
