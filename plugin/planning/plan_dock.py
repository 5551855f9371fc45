"""The panel of cone plans: computed, edited, sent and followed; its menu entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from qgis.core import QgsPointXY
from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QMessageBox,
    QProgressBar,
    QSizePolicy,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages import CollectLayout, GetPlacements
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_ASKED, Level
from ..control.pending_command import in_brief
from ..gateway_client.report_caches import MOST_ASKED
from ..panel.pending_command_panel import OverrideDialog
from ..ui.actions import ActionDock, DockAction
from ..ui.dialogs import ShrinkableScrollArea, confirm, push_button
from ..ui.errors import FleetError
from ..ui.glyphs import WRONG_STYLE
from ..ui.language import first_of, tr, tr_count
from ..ui.steady_widgets import ScrollingText
from .as_placed import AsPlacedPage
from .execution import PlanExecution
from .forms import RobotsForm, SettingsForm
from .plan_editor import CollectionPlanner, PlanEditor
from .plan_settings import PlanSettings, keep_settings, read_settings
from .plan_views import PlanLayers, PlanTree, before_sending, method_text, plan_summary, stop_rows
from .progress import problem_in_words
from .proposal import closed_in_words, meeting_in_words

# --- What the operator does with a plan: send it, and agree to a new one for what is left ---


class ExecutionBar(QWidget):
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
        self.text.setToolTip("\n".join([told, *([] if shown is None else [method_text(shown)])]))
        self.trouble.setText(self._wrong())
        self.trouble.set_text_style(WRONG_STYLE if self.trouble.text() else "")

    def _in_words(self) -> str:
        drafts, driven = self._drafts, self._driven
        if driven.refusal is not None:
            return tr("Not sent as a whole yet")
        if driven.sending is not None:
            return tr("Being sent …")
        if driven.offer is not None:
            return tr("New plan, not sent yet: {summary}", summary=plan_summary(driven.offer))
        if driven.driven is not None and driven.progress is not None:
            done, all_of_them = len(driven.progress.done), len(driven.driven.plan.targets)
            if driven.progress.is_finished(driven.driven.plan):
                return tr_count(all_of_them, "Done: {done} of 1 cone", "Done: {done} of %n cones", done=done)
            under_way = tr_count(
                all_of_them, "Under way: {done} of 1 cone", "Under way: {done} of %n cones", done=done
            )
            return ". ".join([under_way, *driven.pauses_in_words()])
        if drafts.draft is not None:
            return tr("Not sent yet: {summary}", summary=plan_summary(drafts.draft))
        return tr("No plan. Choose cones and robots, then Preview or Solve.")

    def _wrong(self) -> str:
        driven = self._driven
        if driven.refusal is not None:
            hint = tr(" Override… sends it all the same, where your role may.")
            return f"{driven.refusal.words}: {in_brief(driven.refusal.found)}{hint}"
        shown = driven.offer or driven.driven or self._drafts.draft
        near = shown.meetings if shown is not None and (driven.driven is None or driven.offer) else ()
        parts = first_of([meeting_in_words(meeting) for meeting in near])
        if shown is not None and (driven.driven is None or driven.offer):
            parts = [*first_of([closed_in_words(one) for one in shown.closed]), *parts]
        if driven.trouble and driven.offer is None:
            parts.insert(0, problem_in_words(driven.trouble))
        return "; ".join(parts)


# --- The panel of cone plans: made, looked at, changed, sent, watched; and the as-placed report ---


class PlanDock(ActionDock):
    """Puts the parts together. :meth:`remove` undoes what they did outside of it."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(tr("Cone plan"), parent)
        self.setObjectName("fleet_plan_dock")
        self._desk = desk
        self.drafts = PlanEditor(desk, self)
        self.driven = PlanExecution(desk, self.drafts, self)
        self.collecting = CollectionPlanner(desk, self.drafts, self)
        self.layers = PlanLayers(desk)
        self.form = SettingsForm(desk.project, self.drafts.settings)
        self.robots = RobotsForm()
        self.tree = PlanTree()
        self.bar = ExecutionBar(self.drafts, self.driven)
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

    def remove(self) -> None:
        """Stop what is being planned and take the layers out of the project."""
        self.drafts.shut_down()
        self.driven.shut_down()
        self._desk.project.readProject.disconnect(self._read_settings)
        self.form.remove()
        self.layers.remove()

    # --- what the operator does ---

    def make(self, *, preview: bool) -> None:
        """Plan the chosen cones, unless a plan is being driven."""
        driven, progress = self.driven.driven, self.driven.progress
        if driven is not None and progress is not None and not progress.is_finished(driven.plan):
            self._desk.complained.emit(
                tr(
                    "A plan is being driven. Plan what is left, or press Clear to watch it no more; robots "
                    "go on with their queues then."
                )
            )
            return
        self._desk.messages.end(PLAN_ASKED)
        try:
            self.drafts.make(preview=preview)
        except FleetError as error:
            self._refuse(str(error))
        else:
            self.driven.clear()

    def ask_to_send(self) -> None:
        """Say what will happen, and send when the operator agrees."""
        draft = self.drafts.draft
        if draft is None:
            return
        text = before_sending(self._desk, draft)
        send = "fleet_plan_question_send", tr("Send")
        box = confirm(
            self, "fleet_plan_question", text, send, tr("Do not send"), lambda: self._try(self.driven.send)
        )
        box.setWindowTitle(tr("Send the cone plan"))
        self.question = box
        box.open()

    def ask_to_override(self) -> None:
        """Ask why what was refused of the plan is right all the same, and send it on then."""
        refusal = self.driven.refusal
        if refusal is None:
            return
        then = tr("The plan is sent on at once, and robots set off.")
        dialog = OverrideDialog(refusal.words, refusal.found, then, self, is_safe=True)
        dialog.confirmed.connect(lambda why: self._try(lambda: self.driven.override(refusal, why)))
        dialog.open()

    def collect(self, layout: str | None) -> None:
        """Plan who collects what stands of a layout, or all that stands."""
        self._try(lambda: self.collecting.ask(CollectLayout(layout)))

    # --- what it shows ---

    def _refresh(self) -> None:
        driven = self.driven
        shown = driven.offer or driven.driven or self.drafts.draft
        progress = driven.progress if driven.driven is not None else None
        rows = {} if shown is None else stop_rows(shown, progress)
        began_at = None if progress is None else progress.began_at
        self.tree.show_plan(shown, rows, began_at, editable=driven.driven is None and not driven.busy)
        self.layers.show(shown, rows)
        self.bar.refresh()
        expected = len(driven.driven.plan.targets) if driven.driven is not None else None
        self.placed.show_plan(progress.name if progress is not None else None, expected)
        for button in (self.preview, self.solve):
            button.setEnabled(not driven.busy)
        self.cancel.setEnabled(self.drafts.busy)
        if not self.drafts.busy:
            self.progress.reset()
        self.progress.setEnabled(self.drafts.busy)

    def _placements_changed(self) -> None:
        if self._desk.state.placed_cones and self.isVisible():
            self.placed.show_placed()

    def _show_placed_layer(self) -> None:
        if self.placed.isVisible():
            self.layers.show_placed(self.placed.placements)

    def _pulled(self) -> None:
        if self.isVisible() and self._turn.has_come():
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
            self.drafts.settings = settings
            keep_settings(self._desk.project, settings)

    def _read_settings(self, *_: object) -> None:
        self.drafts.settings = read_settings(self._desk.project)
        self.form.show_settings(self.drafts.settings)
        self.bar.by_itself.setChecked(False)

    def _set_by_itself(self, on: bool) -> None:
        self.drafts.settings = replace(self.drafts.settings, by_itself=on)

    def _site_changed(self) -> None:
        """Drop what belongs to other robots; a site that was published anew keeps its plan."""
        if self._generation != self._desk.state.robots.generation:
            self._generation = self._desk.state.robots.generation
            self._clear()

    def _clear(self) -> None:
        self._desk.messages.end(PLAN_ASKED)
        self.driven.clear()
        self.drafts.set_proposal(None)

    def _ask_for_placements(self) -> None:
        self._try(lambda: self._desk.orders.ask(GetPlacements(limit=MOST_ASKED), tr("Placed cones")))

    def _go_to(self, x: float, y: float) -> None:
        ((east, north),) = self._desk.site_to_canvas.transform().to_map([(x, y)]).tolist()
        self._desk.canvas.setCenter(QgsPointXY(east, north))
        self._desk.canvas.refresh()

    def _refuse(self, why: str) -> None:
        """Say why something of a plan was not done; it hangs there until something else is asked for."""
        self._desk.report_failure(why, PLAN_ASKED)

    def _try(self, action: Callable[[], object]) -> None:
        self._desk.messages.end(PLAN_ASKED)
        try:
            action()
        except FleetError as error:
            self._refuse(str(error))

    # --- how it is put together ---

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
        rows.addWidget(self.progress)
        rows.addWidget(self.tree, 1)
        rows.addWidget(self.bar)
        self.tabs = QTabWidget()
        self.tabs.setObjectName("fleet_plan_tabs")
        # The tabs are outside of what scrolls: they are seen wherever that stands.
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
        self.robots.refused.connect(desk.complained)
        self.preview.clicked.connect(lambda: self.make(preview=True))
        self.solve.clicked.connect(lambda: self.make(preview=False))
        self.cancel.clicked.connect(self.drafts.cancel)
        self.tree.move_wanted.connect(lambda *where: self._try(lambda: self.drafts.move(*where)))
        self.tree.remove_wanted.connect(lambda target: self._try(lambda: self.drafts.remove(target)))
        self.tree.place_wanted.connect(self._go_to)
        self.placed.place_wanted.connect(self._go_to)
        bar.send_wanted.connect(self.ask_to_send)
        bar.clear_wanted.connect(self._clear)
        bar.override_wanted.connect(self.ask_to_override)
        bar.leave_wanted.connect(lambda: self._try(self.driven.leave))
        bar.rest_wanted.connect(lambda again: self._try(lambda: self.driven.plan_rest(try_again=again)))
        bar.confirm_wanted.connect(lambda: self._try(self.driven.confirm))
        bar.discard_wanted.connect(lambda: self._try(self.driven.discard))
        bar.resume_wanted.connect(lambda: self._try(self.driven.resume))
        bar.by_itself_changed.connect(self._set_by_itself)
        self.drafts.changed.connect(self._refresh)
        self.driven.changed.connect(self._refresh)
        self.drafts.refused.connect(self._refuse)
        self.driven.remarked.connect(desk.remarked)
        self.collecting.refused.connect(lambda text: desk.messages.post(text, Level.WARNING, PLAN_ASKED))
        self.placed.refresh_wanted.connect(self._ask_for_placements)
        self.placed.collect_wanted.connect(self.collect)
        self.placed.shown.connect(self._show_placed_layer)
        self.placed.layer_wanted.connect(self.layers.placed.finish)
        desk.state.placed_cones_changed.connect(self._placements_changed)
        desk.state.updated.connect(self._pulled)
        self.visibilityChanged.connect(self._shown)
        desk.state.site_changed.connect(self._site_changed)
        desk.project.readProject.connect(self._read_settings)


# --- The menu entry that shows the panel of cone plans ---


class PlansAction(DockAction):
    """The entry and its panel."""

    def __init__(self, iface: QgisInterface, menu: str, desk: FleetController):
        super().__init__(
            iface,
            menu,
            PlanDock(desk, iface.mainWindow()),
            icon="assign_cones.svg",
            text=tr("Cone plan"),
            name="fleet_plan_panel",
            tip=tr("Plan which robot places or collects which cone, send it, watch it; the as-placed report"),
        )
