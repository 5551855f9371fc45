"""The walks: what is played in which QGIS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tools.walkthrough.busy_panel import keep_buttons
from tools.walkthrough.cone_target import send_cone
from tools.walkthrough.connecting import connect
from tools.walkthrough.drives import show_drives
from tools.walkthrough.keepout import lead_round_keepout
from tools.walkthrough.keyboard import work_by_keyboard
from tools.walkthrough.options import keep_connection
from tools.walkthrough.placed_cones import place_cones, report_cones
from tools.walkthrough.print_layout import print_atlas
from tools.walkthrough.replay import play_again
from tools.walkthrough.robot_layer import look_at_layer
from tools.walkthrough.route import send_route
from tools.walkthrough.scene import Scene
from tools.walkthrough.site import open_site, show_site
from tools.walkthrough.stopping import stop_and_clear
from tools.walkthrough.styling import ask_for_surfaces, style_robots
from tools.walkthrough.toolbox import prepare_site
from tools.walkthrough.tour import take_tour


@dataclass(frozen=True)
class Walk:
    """Acts in their order; each goes on where the one before ended.

    :param name: what the names of its pictures begin with.
    :param greeted: the plugin has offered its tour already.
    :param accounts: the gateway lets nobody in without a token.
    :param theme: how QGIS looks, empty for the usual way.
    """

    name: str
    acts: tuple[Callable[[Scene], None], ...]
    greeted: bool = True
    accounts: bool = False
    theme: str = ""


WALKS = (
    Walk(
        "operator",
        (
            take_tour,
            connect,
            send_cone,
            send_route,
            lead_round_keepout,
            stop_and_clear,
            keep_buttons,
            play_again,
        ),
        greeted=False,
    ),
    Walk(
        "qgis",
        (show_site, keep_connection, work_by_keyboard, look_at_layer),
        accounts=True,
        theme="Night Mapping",
    ),
    Walk(
        "processing",
        (
            open_site,
            place_cones,
            prepare_site,
            style_robots,
            ask_for_surfaces,
            print_atlas,
            report_cones,
            show_drives,
        ),
    ),
)
