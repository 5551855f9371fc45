"""Which robots a plan can be made with."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ....robot_bridge.messages import RobotState
from ..picture import STATES, RobotArrays
from .plan_settings import PlanSettings

_IS_HERE = np.array([state in (RobotState.FRESH, RobotState.STALE) for state in STATES])
Which = npt.NDArray[np.bool_]


def has_place(robots: RobotArrays) -> Which:
    """Tell which robots ever said where they are."""
    return np.isfinite(robots.xy).all(axis=1)


def available(robots: RobotArrays) -> Which:
    """Tell which robots can be planned with: they have said where they are, and are not away."""
    return has_place(robots) & _IS_HERE[robots.state]


def taking_part(robots: RobotArrays, settings: PlanSettings) -> Which:
    """Tell which robots can be planned with, and are to be."""
    used = np.array([settings.of_robot(name).used for name in robots.names], dtype=bool)
    return available(robots) & used
