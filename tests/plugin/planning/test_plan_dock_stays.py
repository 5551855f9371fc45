"""No button of the panel of cone plans moves, whatever becomes of a plan."""

from __future__ import annotations

from fleet_supervisor.plugin.control.messages import PLAN_REQUEST
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

from tests.plugin.planning.panel_parts import answer, lose_r1, offered, planned, press, question, queue
from tests.support.button_places import Watched

LONG = "a text as long as none that anybody would write here, with a reason, a place and what to do. " * 4
FOUND = ["the path enters the keepout 'Water basin'. " + LONG] * 3


def test_no_button_of_the_cone_plan_moves(panel, plans, gateway, iface, wait):
    iface.resize(1280, 800)
    iface.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, panel)
    QTest.qWait(50)
    watched = Watched(panel)
    planned(panel, wait)
    watched.check("a plan was made")
    answer(question(panel), send=False)
    watched.check("it was not sent")
    refusal = {"code": -32007, "message": LONG, "data": {"found": FOUND}}
    gateway.answers["submit_plan"] = lambda params: {"error": refusal}
    answer(question(panel), send=True)
    watched.check("it is being sent")
    wait(lambda: panel.driven.refusal is not None, what="the refusal")
    watched.check("it was refused")
    gateway.answers["submit_plan"] = plans.submit
    answer(question(panel), send=True)
    wait(lambda: panel.driven.shown_plan is not None and panel.driven.known is not None, what="the plan")
    watched.check("it is driven")
    tasks = ["current", "waiting", "waiting"]
    gateway.tell("queue", queue(panel, "r1", tasks, state="paused", reason=LONG, by="bob", at=5.0))
    wait(lambda: panel.driven.paused, what="the pause")
    watched.check("its robot is paused, for a long reason")
    lose_r1(panel, plans, wait)
    watched.check("a robot is lost")
    offered(panel, plans, wait, meetings=3)
    watched.check("a new plan is shown")
    press(panel, "fleet_plan_discard")
    wait(lambda: panel.driven.known.report.state.value == "driven", what="the old plan")
    press(panel, "fleet_plan_clear")
    wait(lambda: panel.driven.known is None, what="the end")
    watched.check("it is followed no more")
    panel._refuse(LONG)
    watched.check("something was refused")
    panel._desk.messages.end(PLAN_REQUEST)
    watched.check("that is over")
