"""Which robots are there no more, as a message of positions tells."""

from __future__ import annotations

from typing import Any


def absence(params: dict[str, Any]) -> dict[str, Any]:
    """Return ``removed`` and ``everything`` of a message, as :class:`~.sightings.Sightings` takes them.

    An older gateway tells neither. Raises ValueError where they are not what they have to be.
    """
    everything = params.get("everything", False)
    if not isinstance(everything, bool):
        raise ValueError(f"everything is {everything!r}, neither true nor false")
    return {"removed": texts("removed", params.get("removed", [])), "everything": everything}


def texts(name: str, values: Any) -> list[str]:
    """Return ``values``, a list of texts; raises ValueError, with its ``name``, for anything else."""
    if not isinstance(values, list) or not set(map(type, values)) <= {str}:
        raise ValueError(f"{name} is not a list of texts")
    return values
