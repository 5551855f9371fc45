"""What queues, observations, replays and files were refused for goes when that is over."""

from __future__ import annotations

import time

import pytest
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QPushButton

QUEUE = {"robot": "r1", "revision": 1, "robot_state": "fresh", "by": "bob"}
TASK = {"robot": "r1", "kind": "place", "added_by": "anna", "added_at": 1.0, "x": 60.0, "y": 50.0}
WHY = "not while the moon is full"


@pytest.fixture
def told(iface, wait):
    """Wait until a text hangs in the message bar, or does not any more."""

    def is_told(part=WHY):
        return any(part in text for text in iface.texts())

    class Told:
        def begins(self, part=WHY):
            wait(lambda: is_told(part), what=f"the text {part!r}")

        def ends(self, part=WHY):
            wait(lambda: not is_told(part), what=f"the end of {part!r}")

        def stays(self, part=WHY):
            assert is_told(part)

    return Told()


@pytest.fixture
def tell_queue(at_desk, gateway, wait):
    """Tell of r1's queue with these tasks and their states, and wait until the desk knows it."""
    revisions = iter(range(1, 100))

    def tell(state, **tasks):
        listed = [{**TASK, "task": name, "state": how} for name, how in tasks.items()]
        revision = next(revisions)
        gateway.tell(
            "queue", {**QUEUE, "state": state, "tasks": listed, "at": time.time(), "revision": revision}
        )
        wait(lambda: at_desk.desk.state.queues.revision("r1") == revision, what="the queue")

    return tell


def test_what_a_paused_queue_was_refused_goes_when_it_goes_on(at_desk, gateway, tell_queue, told):
    tell_queue("paused", t1="waiting")
    gateway.refuse["resume_queue"] = WHY
    at_desk.queue_edits.resume("r1")
    told.begins()
    tell_queue("paused", t1="waiting", t2="waiting")
    told.stays()
    tell_queue("running", t1="waiting", t2="waiting")
    told.ends()


@pytest.mark.parametrize("method", ["move_task", "remove_task", "make_current"])
def test_what_was_refused_of_a_task_goes_when_that_is_not_to_be_done_any_more(
    at_desk, gateway, tell_queue, told, method
):
    edits = at_desk.queue_edits
    tell_queue("running", t1="current", t2="waiting", t3="waiting")
    gateway.refuse[method] = WHY
    {"move_task": lambda: edits.move("r1", "t2", None)}.get(
        method, lambda: (edits.remove if method == "remove_task" else edits.make_current)("r1", "t2")
    )()
    told.begins()
    tell_queue("paused", t1="current", t2="waiting")
    told.stays()
    tell_queue("paused", t2="current")
    told.ends()


def test_a_pause_that_was_not_sent_is_told_until_the_queue_is_paused(
    at_desk, gateway, tell_queue, told, wait
):
    tell_queue("running", t1="current")
    queue = {**QUEUE, "state": "running", "tasks": [{**TASK, "task": "t1", "state": "current"}]}
    gateway.answers["get_queue"] = lambda _: {"result": {"queues": [queue]}}
    at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state.link.phase.value == "closed", what="the end of the link")
    at_desk.queue_edits.pause("r1")
    told.begins("Pausing the queue of r1 was NOT sent")
    at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state.link.phase.value == "connected", what="the link")
    wait(lambda: gateway.subscriptions == 2, what="the desk listening again")
    told.stays("Pausing the queue of r1 was NOT sent")
    tell_queue("paused", t1="waiting")
    told.ends("Pausing the queue of r1 was NOT sent")


def test_what_was_refused_for_a_queue_comes_back_as_a_draft_and_goes_with_it(
    at_desk, gateway, iface, told, wait
):
    gateway.refuse["add_tasks"] = WHY
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    at_desk.actions.enqueue.trigger()
    told.begins()
    assert at_desk.desk.drafts.draft is not None
    told.stays()
    at_desk.actions.cancel.trigger()
    told.ends()


# --- observations ---


def tell_observation(gateway, state="pending", number=7):
    where = {"robot": "r1", "op": "SetObject", "object": "bin", "x": 60.0, "y": 50.0}
    gateway.tell("observation", {"observation": number, "state": state, "received_at": time.time(), **where})


@pytest.fixture
def observed(at_desk, gateway, iface, wait):
    iface.findChild(QAction, "fleet_observations").trigger()
    dock = iface.findChild(QDockWidget, "fleet_observation_dock")
    tell_observation(gateway)
    wait(lambda: dock.model.rowCount() == 1, what="the observation")
    dock.choose(7)
    return dock


def test_a_review_that_was_refused_is_told_until_somebody_has_reviewed_it(observed, gateway, told):
    gateway.refuse["review_observation"] = WHY
    observed.findChild(QPushButton, "fleet_observation_accept").click()
    told.begins()
    tell_observation(gateway, number=8)
    told.stays()
    tell_observation(gateway, "rejected")
    told.ends()


# --- replays ---


@pytest.fixture
def replay(at_desk, gateway, iface):
    gateway.answers["get_trajectory"] = lambda _: {"result": {"places": [], "next": None}}
    next(action for action in iface.plugins.actions() if action.objectName() == "fleet_replay").trigger()
    return iface.findChild(QDockWidget, "fleet_replay_dock")


def test_a_replay_that_was_not_loaded_is_told_until_one_is(replay, at_desk, told, wait):
    at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state.link.phase.value == "closed", what="the end of the link")
    replay.load()
    told.begins("The replay was not loaded")
    at_desk.actions.connect.trigger()
    wait(lambda: at_desk.desk.state.link.phase.value == "connected", what="the link")
    told.stays("The replay was not loaded")
    replay.load()
    told.ends("The replay was not loaded")


def test_without_a_robot_to_be_replayed_that_is_said_until_one_is_selected(replay, at_desk, told):
    at_desk.desk.selection.select(None)
    replay.form.selected.setChecked(True)
    replay.load()
    told.begins("No robot is selected to be replayed")
    at_desk.desk.selection.select("r1")
    told.ends("No robot is selected to be replayed")


# --- files ---


def test_a_log_that_was_not_written_is_told_until_it_is(at_desk, told, tmp_path):
    (tmp_path / "log.csv").mkdir()
    at_desk.dock.log.export(str(tmp_path / "log.csv"))
    told.begins("was not written")
    at_desk.dock.log.export(str(tmp_path / "other.csv"))
    told.ends("was not written")
