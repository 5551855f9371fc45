"""The expression functions ``robot_state``, ``robot_battery`` and ``robot_age``."""

from __future__ import annotations

from collections.abc import Callable

from qgis.core import NULL, QgsExpressionFunction

from .robots_now import FleetNow, RobotsNow

GROUP = "Fleet"
_NOT_KNOWN = (
    "NULL stands for a robot that the gateway has not told of, and while this QGIS is connected to none. "
    "What is not known of a robot is NULL as well."
)


class RobotValue(QgsExpressionFunction):
    """Tells one thing of a robot by its name."""

    def __init__(self, name: str, help_text: str, fleet: FleetNow, value: Callable[[RobotsNow, str], object]):
        super().__init__(name, [QgsExpressionFunction.Parameter("robot")], GROUP, help_text)
        self._fleet, self._value = fleet, value

    def isStatic(self, _node, _parent, _context):
        # QGIS works out once what cannot change; robots do.
        return False

    def usesGeometry(self, _node):
        return False

    def referencedColumns(self, _node):
        return set()

    def func(self, values, _context, _parent, _node):
        robots = self._fleet.robots
        if robots is None or values[0] is None or values[0] == NULL:
            return None
        return self._value(robots, str(values[0]))


def robot_values(fleet: FleetNow) -> list[RobotValue]:
    """Return the functions; each needs to be kept as long as QGIS has it."""
    return [
        RobotValue(
            "robot_state",
            _help(
                "robot_state",
                "Returns how far what is known of a robot can be trusted: 'fresh', 'stale', 'lost' or "
                "'offline'.",
                "robot_state('r1') &rarr; 'fresh'",
                "robot_state(\"robot\") IN ('stale', 'lost') &rarr; true of robots that are silent",
            ),
            fleet,
            RobotsNow.state,
        ),
        RobotValue(
            "robot_battery",
            _help(
                "robot_battery",
                "Returns how full a robot's battery is, 0 to 1.",
                "robot_battery('r1') &rarr; 0.82",
                "round(100 * robot_battery('r1')) || ' %' &rarr; '82 %'",
            ),
            fleet,
            RobotsNow.charge,
        ),
        RobotValue(
            "robot_age",
            _help(
                "robot_age",
                "Returns the seconds since a robot's last message, by this computer's clock.",
                "robot_age('r1') &rarr; 0.4",
                "robot_age('r1') &gt; 10 &rarr; true once it has been silent for more than 10 seconds",
            ),
            fleet,
            RobotsNow.silence,
        ),
    ]


def _help(name: str, says: str, *examples: str) -> str:
    listed = "".join(f"<li><code>{example}</code></li>" for example in examples)
    return (
        f"<h3>function {name}</h3><p>{says}</p><h4>Syntax</h4><p><code>{name}(robot)</code></p>"
        "<h4>Arguments</h4><table><tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr>"
        f"</table><h4>Examples</h4><ul>{listed}</ul><h4>Notes</h4><p>{_NOT_KNOWN} Values are at most half "
        "a second old; a layer shows them when it is drawn.</p>"
    )
