"""A page of where robots have been, as an operator asks for it."""

from __future__ import annotations

from ..messages import GetTrajectory, Trajectory, TrajectoryPlace
from ..messages.trajectories import mark_text
from ..store import trajectories
from ..store.database import Database
from ..store.trajectories import Mark, Wanted


async def get_trajectory(database: Database, request: GetTrajectory) -> Trajectory:
    """Return the page of stored positions that ``request`` asks for; raises StoreError."""
    wanted = Wanted(tuple(request.robots), request.since, request.until, request.bounds)
    mark = request.mark()
    after = None if mark is None else Mark(*mark)
    places = await database.run(trajectories.read, wanted, request.limit, after)
    more = len(places) == request.limit
    return Trajectory(
        places=[TrajectoryPlace(*place[1:]) for place in places],
        next=mark_text(places[-1].received_at, places[-1].id) if more else None,
    )
