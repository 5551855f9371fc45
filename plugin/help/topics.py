"""Which page and which heading of the guides a part of the window is explained under."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.PyQt.QtWidgets import QWidget


@dataclass(frozen=True)
class Topic:
    """A page of docs/ without its suffix, and a heading in it as links write it; empty for the page's top."""

    page: str
    heading: str = ""


START = Topic("operator")
CONNECTIONS = Topic("operator", "connections")
OPTIONS = Topic("operator", "options")
ACCOUNTS = Topic("operator", "accounts")
SITES = Topic("operator", "which-site-is-served")
RECORDINGS = Topic("operator", "recordings-on-the-map")

TOPICS = {
    "fleet_url": Topic("operator", "connect"),
    "fleet_operator": Topic("operator", "connect"),
    "fleet_connect_button": Topic("operator", "connect"),
    "fleet_access_button": Topic("operator", "connect"),
    "fleet_token": Topic("operator", "connect"),
    "fleet_ca_file": Topic("operator", "connect"),
    "fleet_connections_button": CONNECTIONS,
    "fleet_robot_table": Topic("operator", "see-the-robots"),
    "fleet_cone_target_button": Topic("operator", "send-a-cone-target"),
    "fleet_road_route_button": Topic("operator", "send-along-the-roads"),
    "fleet_draw_route_button": Topic("operator", "draw-a-route"),
    "fleet_command_log": Topic("operator", "watch-it-being-done"),
    "fleet_queue": Topic("operator", "queues"),
    "fleet_abort_button": Topic("operator", "stop-robots"),
    "fleet_abort_all_button": Topic("operator", "stop-robots"),
    "fleet_emergency_stop_button": Topic("operator", "emergency-stop"),
}
"""By the object name of a widget; what lies in one belongs to it."""


def topic_of(widget: QWidget | None) -> Topic:
    """Return what explains ``widget`` or the nearest one around it."""
    while widget is not None:
        if widget.objectName() in TOPICS:
            return TOPICS[widget.objectName()]
        widget = widget.parentWidget()
    return START
