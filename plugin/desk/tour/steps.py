"""What the tour says, and at what it points."""

from __future__ import annotations

from dataclasses import dataclass

from ...language import tr

PROJECT = "project"
FLEET = "fleet"


@dataclass(frozen=True)
class Step:
    """One page of the tour.

    ``target`` is the object name of the widget that it points at. ``offer`` is what its button does, and
    ``button`` the words on it. ``practice`` is said only while the desk is connected to the practice fleet,
    as it asks for what would move or stop real robots on another one.
    """

    title: str
    text: str
    target: str = ""
    offer: str = ""
    button: str = ""
    practice: str = ""


STEPS = (
    Step(
        tr("Five minutes with a practice fleet"),
        tr(
            "The tour needs no network: a gateway and three simulated robots run on this computer, and "
            "nothing real moves. Next and Back lead on, Esc closes. It is in the menu Plugins > Fleet "
            "Supervisor > Tour."
        ),
    ),
    Step(
        tr("The site"),
        tr(
            "A site is an ordinary QGIS project: an orthophoto, roads, obstacles, each layer with a role. "
            "Open the sample site; QGIS asks first if your own project is not saved."
        ),
        offer=PROJECT,
        button=tr("Open the sample site"),
    ),
    Step(
        tr("The link"),
        tr(
            "Here stand the gateway's address and your name, which every log shows. For a real fleet write "
            "them and press Connect. For the tour, start the practice fleet: it connects by itself."
        ),
        "fleet_connection_panel",
        FLEET,
        tr("Start the practice fleet"),
    ),
    Step(
        tr("The robots"),
        tr(
            "Each robot has a row: its state, its task, its battery, and how old its last message is. A "
            "robot that falls silent is stale, then lost; it stays on the map, marked."
        ),
        "fleet_robot_table",
        practice=tr("Click r1: it is selected on the map, too."),
    ),
    Step(
        tr("The map"),
        tr(
            "An arrow shows where a robot heads, its colour and shape the state. Hold the mouse over one "
            "for its card; with Select robot a click selects, a rectangle selects several, a double click "
            "goes there."
        ),
        "fleet_select_button",
    ),
    Step(
        tr("Send a robot"),
        tr(
            "Cone target, a click on the map, Enter: that sends the selected robot. Before that it is a "
            "draft, checked against the site; Esc takes it away, and nothing was sent."
        ),
        "fleet_cone_target_button",
        practice=tr("Try it: press Cone target, click on the road near r1, then Enter."),
    ),
    Step(
        tr("What became of it"),
        tr(
            "Every command is here with each of its steps: queued, delivered, acknowledged, reached; or "
            "why it failed. A double click shows its place on the map."
        ),
        "fleet_command_log",
    ),
    Step(
        tr("Stop"),
        tr(
            "Abort robot: the selected robots give up their task. ABORT ALL: every robot does. EMERGENCY "
            "STOP (F10): every robot stops now, and none can be sent anywhere until a supervisor clears it."
        ),
        "fleet_emergency_stop_button",
        practice=tr("Try it: only practice robots stop. Then clear it in the red banner."),
    ),
    Step(
        tr("That was the tour"),
        tr(
            "Closing it ends the practice fleet. What else the desk does is in the operator's guide, "
            "docs/operator.md; how real robots are connected in docs/integrator.md."
        ),
    ),
)
