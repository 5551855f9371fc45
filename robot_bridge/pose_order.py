"""Which pose of a robot is newest: by the time of its fix, else by the robot's clock, else as they come."""

from __future__ import annotations

from dataclasses import dataclass

CLOCK_SET_BACK_AFTER = 3.0
"""seconds of nothing but late poses, on the link of the newest one and at the pace of a clock, after which
the robot's clock must have been set back: within one link messages do not overtake each other."""
LONGEST_DELAY = 30.0
"""seconds of nothing but late poses after which they count whatever their pace and link: no link holds
messages back for longer, and a robot must not stand still on the map for ever."""
PACE = (0.5, 1.5)
"""seconds of the robot's clock for each second of the gateway's that still pass for a clock; what was kept
back and is now sent in one go comes faster."""


@dataclass
class _LateRun:
    """Late poses since the last one that counted; ``paced_*`` is where their pace is measured from."""

    since: float
    paced_since: float
    paced_stamp: float


@dataclass
class PoseOrder:
    """The stamps of a robot's newest pose, by its own clocks, and the link that it came on."""

    fix_t: float | None = None
    t: float | None = None
    link: str = ""
    _late: _LateRun | None = None

    def admit(self, fix_t: float | None, t: float | None, link: str, now: float) -> bool:
        """Tell whether a pose with these stamps counts, and take it for the newest if so.

        ``now`` is the gateway's clock, seconds. A pose is late when its fix is older than that of the newest,
        or as old and sent earlier; where one of the two has no fix time, when it was sent earlier. A pose
        without any stamp counts as it comes.
        """
        if fix_t is not None or t is None or (self.t is not None and t < self.t):
            stamp = self._late_by(fix_t, t)
            if stamp is not None and not self._set_back(stamp, link, now):
                return False
        self.fix_t = self.fix_t if fix_t is None else fix_t
        self.t = self.t if t is None else t
        self.link = link
        self._late = None
        return True

    def restarted(self) -> None:
        """Forget the robot's own clock: a robot that started anew may count from nought."""
        self.t = self._late = None

    def _late_by(self, fix_t: float | None, t: float | None) -> float | None:
        """Return the stamp by which a pose is late, or None for one that is not."""
        if fix_t is not None and self.fix_t is not None and fix_t != self.fix_t:
            return fix_t if fix_t < self.fix_t else None
        return t if t is not None and self.t is not None and t < self.t else None

    def _set_back(self, stamp: float, link: str, now: float) -> bool:
        """Tell whether poses have been late for so long that it must be the robot's clock."""
        run = self._late
        if run is None or now < run.since:
            self._late = _LateRun(now, now, stamp)
            return False
        if now - run.since >= LONGEST_DELAY:
            return True
        elapsed = now - run.paced_since
        if elapsed < CLOCK_SET_BACK_AFTER:
            return False
        if PACE[0] * elapsed <= stamp - run.paced_stamp <= PACE[1] * elapsed:
            return link == self.link
        run.paced_since, run.paced_stamp = now, stamp
        return False
