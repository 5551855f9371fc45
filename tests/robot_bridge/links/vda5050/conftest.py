"""A gateway, a broker, an adapter and vehicles, each a process of its own."""

from __future__ import annotations

import pytest

from tests.robot_bridge.links.vda5050.driving import begin
from tests.robot_bridge.links.vda5050.peers import Yard, require_peers


@pytest.fixture(scope="module")
def modules(root):
    return require_peers(root)


@pytest.fixture(scope="module")
def bridge(start_bridge, impatient_site):
    bridge = start_bridge(impatient_site)
    yield bridge
    bridge.end()


@pytest.fixture
def desk(bridge):
    desk = bridge.desk()
    desk.ask("subscribe", {"rate": 10})
    yield desk
    # What nobody reads any more would be sent all the same.
    desk.hang_up()


@pytest.fixture(scope="module")
def standing_yard(bridge, modules, tmp_path_factory):
    """Broker and adapter of this module, which its tests kill and start again."""
    from tests.support.processes import Processes

    folder = tmp_path_factory.mktemp("yard")
    with Processes(folder / "logs") as processes:
        yard = Yard(processes, folder, modules)
        yard.start_broker()
        yard.start_adapter(bridge.address, "unanswered_after_s = 2.0")
        yield yard
        yard.end()
        assert "Traceback" not in yard.output("adapter"), yard.output("adapter")


@pytest.fixture
def yard(standing_yard):
    """The same with vehicles of one test: all that published on would be worked for until the last test."""
    yield standing_yard
    standing_yard.end_vehicles()


@pytest.fixture
def vehicle(yard, desk):
    """A vehicle that stands at (20, 8) of the site and is seen at the desk; its name."""
    return begin(yard, desk)
