"""The expression functions ``robot_state``, ``robot_battery`` and ``robot_age``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from qgis.core import (
    NULL,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionFunction,
    QgsExpressionNodeFunction,
)

from ..language import tr, tr_page
from .robots_now import FleetNow, RobotsNow

GROUP = tr("Fleet")
_STATE_HELP = tr_page("""
<h3>function robot_state</h3>
<p>Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or 'offline'.</p>
<h4>Syntax</h4>
<p><code>robot_state(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_state('r1')</code> &rarr; 'fresh'</li>
<li><code>robot_state("robot") IN ('stale', 'lost')</code> &rarr; true of robots that are silent</li>
</ul>
""")
_BATTERY_HELP = tr_page("""
<h3>function robot_battery</h3>
<p>Returns how full a robot's battery is, 0 to 1.</p>
<h4>Syntax</h4>
<p><code>robot_battery(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_battery('r1')</code> &rarr; 0.82</li>
<li><code>round(100 * robot_battery('r1')) || ' %'</code> &rarr; '82 %'</li>
</ul>
""")
_AGE_HELP = tr_page("""
<h3>function robot_age</h3>
<p>Returns the seconds since a robot's last message, by this computer's clock.</p>
<h4>Syntax</h4>
<p><code>robot_age(robot)</code></p>
<h4>Arguments</h4>
<table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr></table>
<h4>Examples</h4>
<ul>
<li><code>robot_age('r1')</code> &rarr; 0.4</li>
<li><code>robot_age('r1') &gt; 10</code> &rarr; true once it has been silent for more than 10 seconds</li>
</ul>
""")
_NOTES = tr_page("""
<h4>Notes</h4>
<p>NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. What is
not known of a robot is NULL as well. Values are at most half a second old; a layer shows them when it is
drawn.</p>
""")


class RobotValue(QgsExpressionFunction):
    """Tells one thing of a robot by its name."""

    def __init__(self, name: str, help_text: str, fleet: FleetNow, value: Callable[[RobotsNow, str], object]):
        super().__init__(name, [QgsExpressionFunction.Parameter("robot")], GROUP, help_text)
        self._fleet, self._value = fleet, value

    def isStatic(
        self, _node: QgsExpressionNodeFunction, _parent: QgsExpression, _context: QgsExpressionContext
    ):
        # QGIS works out once what cannot change; robots do.
        return False

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return False

    def referencedColumns(self, _node: QgsExpressionNodeFunction):
        return set()

    def func(
        self,
        values: Sequence[Any],
        _context: QgsExpressionContext,
        _parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        robots = self._fleet.robots
        if robots is None or values[0] is None or values[0] == NULL:
            return None
        return self._value(robots, str(values[0]))


def robot_values(fleet: FleetNow) -> list[RobotValue]:
    """Return the functions; each needs to be kept as long as QGIS has it."""
    return [
        RobotValue("robot_state", _STATE_HELP + _NOTES, fleet, RobotsNow.state),
        RobotValue("robot_battery", _BATTERY_HELP + _NOTES, fleet, RobotsNow.charge),
        RobotValue("robot_age", _AGE_HELP + _NOTES, fleet, RobotsNow.silence),
    ]
