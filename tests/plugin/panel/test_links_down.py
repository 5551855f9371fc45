"""Links to robots of another kind that are down, as operators are told of them."""

from __future__ import annotations

from fleet_supervisor.plugin.control.messages import LinkNotices
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.links import LinkReport, Links, links_report


def report(**more):
    return Links([LinkReport("cars", "tracker", True), LinkReport("agvs", "vda5050", False, **more)])


def test_a_link_that_is_down_is_told_once_with_its_robots_until_it_is_back():
    notices = LinkNotices()
    began, over = [], []
    notices.began.connect(began.append)
    notices.over.connect(over.append)
    down = report(text="it is not connected", robots=[f"agv-{n}" for n in range(7)], count=9)
    notices.show(links_report(to_json(down)))
    notices.show(down)
    assert began == [
        "Link agvs is down: it is not connected. "
        "Nothing reaches agv-0, agv-1, agv-2, agv-3, agv-4 and 4 more."
    ]
    notices.show(Links())
    assert over == began
    notices.show(report(text="the broker refuses the password"))
    assert began[1] == "Link agvs is down: the broker refuses the password."
    notices.show(
        Links([LinkReport("agvs", "vda5050", True, "agv-1: emergency stop at the vehicle (MANUAL)")])
    )
    assert began[2] == "Link agvs: agv-1: emergency stop at the vehicle (MANUAL)."
    notices.show(Links([LinkReport("agvs", "vda5050", True)]))
    assert over == began
