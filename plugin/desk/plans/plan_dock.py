"""The panel of cone plans: made, looked at, changed, sent, watched; and the as-placed report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from qgis.core import QgsPointXY
from qgis.PyQt.QtWidgets import (
    QHBoxLayout,
    QMessageBox,
    QProgressBar,
    QSizePolicy,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.messages import CollectLayout, GetPlacements
from ...errors import FleetError
from ...language import tr
from ..commands.override_dialog import OverrideDialog
from ..desk import Desk
from ..dock_action import ActionDock
from ..messages import PLAN_ASKED, Level
from ..placement_book import MOST_ASKED
from ..push_button import push_button
from ..safe_question import safe_question
from ..tall_content import TallContent
from .as_placed_page import AsPlacedPage
from .collecting import Collecting
from .draft_plan import DraftPlan
from .driven_plan import DrivenPlan
from .driving_bar import DrivingBar
from .plan_layers import PlanLayers
from .plan_rows import rows_of
from .plan_settings import PlanSettings, keep_settings, settings_in
from .plan_tree import PlanTree
from .robots_form import RobotsForm
from .sending_check import before_sending
from .settings_form import SettingsForm


class PlanDock(ActionDock):
    """Puts the parts together. :meth:`remove` undoes what they did outside of it."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(tr("Cone plan"), parent)
        self.setObjectName("fleet_plan_dock")
        self._desk = desk
        self.drafts = DraftPlan(desk, self)
        self.driven = DrivenPlan(desk, self.drafts, self)
        self.collecting = Collecting(desk, self.drafts, self)
        self.layers = PlanLayers(desk)
        self.form = SettingsForm(desk.project, self.drafts.settings)
        self.robots = RobotsForm()
        self.tree = PlanTree()
        self.bar = DrivingBar(self.drafts, self.driven)
        self.placed = AsPlacedPage(desk)
        self.preview = push_button("fleet_plan_preview", tr("Preview"), tr("A quick plan, to look at"))
        self.solve = push_button(
            "fleet_plan_solve", tr("Solve"), tr("A good plan, within the time that is given")
        )
        self.cancel = push_button("fleet_plan_cancel", tr("Cancel"), tr("Give up what is being planned"))
        self.progress = QProgressBar()
        self._turn = desk.beat.turn()
        self.question: QMessageBox | None = None
        self._generation = desk.picture.generation
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
        box = safe_question(
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
        rows = {} if shown is None else rows_of(shown, progress)
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
        if self._desk.placements and self.isVisible():
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
        self.drafts.settings = settings_in(self._desk.project)
        self.form.show_settings(self.drafts.settings)
        self.bar.by_itself.setChecked(False)

    def _set_by_itself(self, on: bool) -> None:
        self.drafts.settings = replace(self.drafts.settings, by_itself=on)

    def _site_changed(self) -> None:
        """Drop what belongs to other robots; a site that was published anew keeps its plan."""
        if self._generation != self._desk.picture.generation:
            self._generation = self._desk.picture.generation
            self._clear()

    def _clear(self) -> None:
        self._desk.messages.end(PLAN_ASKED)
        self.driven.clear()
        self.drafts.put(None)

    def _ask_for_placements(self) -> None:
        self._try(lambda: self._desk.ask(GetPlacements(limit=MOST_ASKED), tr("Placed cones")))

    def _go_to(self, x: float, y: float) -> None:
        ((east, north),) = self._desk.placement().to_map([(x, y)]).tolist()
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
        self.tabs.addTab(TallContent(plan), tr("Plan"))
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
        desk.placements_changed.connect(self._placements_changed)
        desk.pulled.connect(self._pulled)
        self.visibilityChanged.connect(self._shown)
        desk.site_changed.connect(self._site_changed)
        desk.project.readProject.connect(self._read_settings)
