"""A plugin that does not start leaves QGIS as it was, and starts the next time."""

from __future__ import annotations

import gc
import inspect
import sys

import pytest
from fleet_supervisor.plugin.control.fleet_controller import FleetController
from fleet_supervisor.plugin.locator import RobotLocator
from fleet_supervisor.plugin.map.overlay.task_painter import QueueMarks
from fleet_supervisor.plugin.map.tools.drawing_tools import ConeTool
from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import QgsExpression

from tests.support.left_behind import left_behind

PACKAGE = "fleet_supervisor.plugin."


def state_of(iface):
    return {**left_behind(iface), "functions": len(QgsExpression.Functions())}


def classes_built(iface, monkeypatch):
    """Return the plugin's classes of which a start makes objects."""
    start_and_end(iface)  # imports them
    modules = [module for name, module in sys.modules.items() if name.startswith(PACKAGE)]
    classes = {one for module in modules for one in vars(module).values() if inspect.isclass(one)}
    built = {}
    with monkeypatch.context() as watched:
        for one in classes:
            if one.__module__.startswith(PACKAGE) and "__init__" in vars(one):
                watched.setattr(one, "__init__", noting(one, built))
        start_and_end(iface)
    del built[f"{PACKAGE}plugin.FleetPlugin"]
    return [one for _, one in sorted(built.items())]


def start_and_end(iface):
    plugin = FleetPlugin(iface)
    plugin.initGui()
    assert plugin.window is not None
    plugin.unload()


def noting(one, built):
    make = one.__init__

    def make_noted(self, *args, **named):
        built[f"{one.__module__}.{one.__qualname__}"] = one
        make(self, *args, **named)

    return make_noted


def fail(*_, **__):
    raise RuntimeError("no such thing")


def test_what_was_there_before_it_failed_is_taken_out_whatever_fails(iface, monkeypatch):
    parts = classes_built(iface, monkeypatch)
    # What tests before have made is half a million objects, and each state looks through all.
    gc.collect()
    gc.freeze()
    before = state_of(iface)
    failed, left = 0, {}
    for part in parts:
        plugin = FleetPlugin(iface)
        with monkeypatch.context() as broken:
            broken.setattr(part, "__init__", fail)
            try:
                plugin.initGui()
            except RuntimeError as error:
                assert str(error) == "no such thing"
                failed += 1
            else:
                # It is made again for each message, say.
                plugin.unload()
        assert plugin.window is None
        after = state_of(iface)
        left |= {(part.__name__, kind): count for kind, count in after.items() if count != before[kind]}
        before = after
    assert failed > 150
    assert not left
    start_and_end(iface)
    assert state_of(iface) == before


@pytest.mark.parametrize(
    ("part", "name"),
    [
        (RobotLocator, "remove"),
        (QueueMarks, "remove"),
        (FleetController, "shut_down"),
        (ConeTool, "deleteLater"),
    ],
)
def test_all_the_others_are_taken_out_where_one_part_fails_to_go(iface, monkeypatch, part, name):
    go = getattr(part, name)

    def fail_after(self):
        go(self)
        raise RuntimeError("it will not go")

    before = state_of(iface)
    plugin = FleetPlugin(iface)
    plugin.initGui()
    monkeypatch.setattr(part, name, fail_after)
    with pytest.raises(RuntimeError, match="it will not go"):
        plugin.unload()
    assert plugin.window is None
    assert state_of(iface) == before
