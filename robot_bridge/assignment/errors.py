"""The exception family of the assignment of cones to robots."""

from __future__ import annotations


class AssignmentError(Exception):
    """Something is wrong with a task or a plan; names what, where, and what to do."""


class JobError(AssignmentError):
    """Targets, robots or stores that cannot be planned for: numbers that are none, names used twice."""


class MissingStoreError(JobError):
    """Robots have to load or unload cones, and no store is given."""


class UnservedError(AssignmentError):
    """Targets that no robot can serve; ``targets`` are their ids."""

    def __init__(self, message: str, targets: tuple[str, ...]) -> None:
        super().__init__(message)
        self.targets = targets


class MissingSolverError(AssignmentError):
    """A method was asked for by name whose package this Python does not have."""


class CancelledError(AssignmentError):
    """Whoever asked for the plan does not want it any more."""


class EditError(AssignmentError):
    """A change of a plan that cannot be made; the plan is as it was."""


class PlanFileError(AssignmentError):
    """A file that is no plan."""
