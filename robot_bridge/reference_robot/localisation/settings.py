"""Settings of the robot and its simulated world: one TOML file, a table for each part."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from ...core.json_decoder import toml_tables


class ReferenceRobotError(Exception):
    """Something the robot cannot do; the text names what was wrong, where, and what to do."""


LARGEST = 64_000
"""bytes of a settings file."""

Share = Annotated[float, msgspec.Meta(ge=0, le=1)]
Metres = Annotated[float, msgspec.Meta(ge=0, le=1000)]
Positive = Annotated[float, msgspec.Meta(gt=0, le=1000)]
Degrees = Annotated[float, msgspec.Meta(ge=0, le=360)]


class WorldSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How the world differs from the map.

    Each wall is moved by up to ``moved`` metres in x and in y; ``missing`` is the share of furniture
    (what is less than ``furniture`` metres wide) that is not there.
    """

    moved: Metres = 0.0
    missing: Share = 0.0
    furniture: Positive = 3.0


class LaserSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A laser that scans a plane ``height`` metres above the ground, as far as ``reach`` metres.

    ``beams`` are spread over ``field_deg`` degrees. ``noise`` is the standard deviation of a range, metres;
    ``short`` the share of beams that something in the way cuts short, ``dropout`` that of beams without a
    reading.
    """

    reach: Positive = 30.0
    field_deg: Annotated[float, msgspec.Meta(gt=0, le=360)] = 270.0
    beams: Annotated[int, msgspec.Meta(ge=1, le=10_000)] = 90
    height: Metres = 0.4
    noise: Metres = 0.03
    short: Share = 0.0
    dropout: Share = 0.02


class OdometrySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Wheels: standard deviations of what is wrong for a whole run, and of the noise.

    ``scale`` is of the distance, ``drift_deg`` degrees for each metre; ``noise`` metres for the square root
    of each metre, ``turn_noise`` of the turn.
    """

    scale: Share = 0.01
    drift_deg: Degrees = 0.1
    noise: Metres = 0.01
    turn_noise: Share = 0.02


class GyroscopeSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Standard deviations: ``bias_deg`` degrees a second for a whole run, ``noise_deg`` for √s."""

    bias_deg: Degrees = 0.02
    noise_deg: Degrees = 0.05


class GpsSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A receiver with ``noise`` metres that has no fix where too little of the sky is open.

    Of ``directions`` all around, those are open in which nothing reaches above ``mask_deg`` degrees.
    """

    noise: Metres = 1.5
    mask_deg: Degrees = 40.0
    open_share: Share = 0.35
    directions: Annotated[int, msgspec.Meta(ge=4, le=360)] = 24


class FilterSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The particle filter: motion, beams, number of particles and recovery.

    ``distance_noise`` is of the distance, ``turn_noise`` of the turn, ``drift_deg`` degrees for each
    metre, ``slip`` metres sideways for each metre: standard deviations by which particles are spread.
    ``sigma`` is how far a beam may be from the map, metres, the map's own errors included; ``hit``,
    ``short``, ``far`` and ``random`` are the weights of the beam model's parts. ``beams_of_worth`` is how
    many independent beams a scan counts for: neighbouring beams see the same wall, whose place in the map is
    wrong for all of them. ``least`` to ``most`` particles, so many that with a probability of 99 % their
    error (Kullback-Leibler) is below ``kld_error`` over bins of ``bin_size`` metres and ``bin_turn_deg``
    degrees. ``slow`` and ``fast`` are the rates at which the agreement of scans and map is averaged;
    particles are put where a scan fits once the fast average is below ``recover`` times the slow one. Below
    ``least_agreement`` the place is not known, whatever is usual.
    """

    model: Literal["beam", "field"] = "beam"
    distance_noise: Share = 0.05
    turn_noise: Share = 0.05
    drift_deg: Degrees = 0.3
    slip: Share = 0.02
    sigma: Positive = 0.15
    hit: Share = 0.6
    short: Share = 0.25
    far: Share = 0.05
    random: Share = 0.1
    beams_of_worth: Positive = 12.0
    least: Annotated[int, msgspec.Meta(ge=10, le=100_000)] = 500
    most: Annotated[int, msgspec.Meta(ge=10, le=100_000)] = 10_000
    kld_error: Annotated[float, msgspec.Meta(gt=0, le=1)] = 0.05
    bin_size: Positive = 0.5
    bin_turn_deg: Annotated[float, msgspec.Meta(gt=0, le=360)] = 10.0
    slow: Share = 0.02
    fast: Share = 0.2
    recover: Share = 0.6
    least_agreement: Share = 0.3


class LocalisedRobotSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All of it."""

    world: WorldSettings = WorldSettings()
    laser: LaserSettings = LaserSettings()
    odometry: OdometrySettings = OdometrySettings()
    gyroscope: GyroscopeSettings = GyroscopeSettings()
    gps_receiver: GpsSettings = GpsSettings()
    filter: FilterSettings = FilterSettings()


def settings_tables(file: Path) -> dict[str, object]:
    """Return the tables in a TOML ``file``; raises ReferenceRobotError."""
    try:
        with file.open("rb") as opened:
            content = opened.read(LARGEST + 1)
        if len(content) > LARGEST:
            raise ReferenceRobotError(f"settings {file}: more than {LARGEST} bytes")
        return toml_tables(content.decode())
    except OSError as error:
        raise ReferenceRobotError(
            f"settings {file} cannot be read: {error.strerror or error}; name another file"
        ) from None
    except ValueError as error:
        raise ReferenceRobotError(f"settings {file} are no TOML: {error}") from None
