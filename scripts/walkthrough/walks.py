"""The walks: what is played in which QGIS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .cone_target import send_cone
from .connecting import connect
from .keyboard import work_by_keyboard
from .options import keep_connection
from .replay import play_again
from .robot_layer import look_at_layer
from .route import send_route
from .scene import Scene
from .site import drop_site
from .stopping import stop_and_clear
from .tour import take_tour


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
    Walk("operator", (take_tour, connect, send_cone, send_route, stop_and_clear, play_again), greeted=False),
    Walk(
        "qgis",
        (drop_site, keep_connection, work_by_keyboard, look_at_layer),
        accounts=True,
        theme="Night Mapping",
    ),
)
