"""Settings of the robot and its simulated world: one TOML file, a table for each part."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec

from ...core.json_decoder import toml_tables


class ReferenceRobotError(Exception):
    """Something the robot cannot do; the text names the cause, the place and the remedy."""


LARGEST = 64_000
"""bytes of a settings file."""

Share = Annotated[float, msgspec.Meta(ge=0, le=1)]
Metres = Annotated[float, msgspec.Meta(ge=0, le=1000)]
Positive = Annotated[float, msgspec.Meta(gt=0, le=1000)]
Degrees = Annotated[float, msgspec.Meta(ge=0, le=360)]
Angle = Annotated[float, msgspec.Meta(gt=0, le=360)]
Radians = Annotated[float, msgspec.Meta(ge=0, le=6.2832)]
Count = Annotated[int, msgspec.Meta(ge=1, le=10_000_000)]


class WorldSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Differences between the world and the map.

    Each wall is moved by up to ``moved`` metres in x and in y; ``missing`` is the share of absent furniture
    (objects less than ``furniture`` metres wide).
    """

    moved: Metres = 0.0
    missing: Share = 0.0
    furniture: Positive = 3.0


class LaserSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A laser that scans a plane ``height`` metres above the ground, as far as ``reach`` metres.

    ``beams`` are spread over ``field_deg`` degrees. ``noise`` is the standard deviation of a range, metres;
    ``short`` the share of beams shortened by something in the way, ``dropout`` that of beams without a
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
    """Wheels: standard deviations of systematic errors of a run, and of the noise.

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

    Of ``directions`` all around, those without obstacles above ``mask_deg`` degrees are open.
    """

    noise: Metres = 1.5
    mask_deg: Degrees = 40.0
    open_share: Share = 0.35
    directions: Annotated[int, msgspec.Meta(ge=4, le=360)] = 24


class SearchSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Search for places where a scan fits on a map: table ``[filter.search]``.

    ``per_area`` random poses for each m² are compared at first, ``most`` of them on a large map: a pose of
    them is then some 0.2 m and at most 10° from the robot. While it is lost it repeats the search, with
    ``again_per_area`` for each m² and ``again_most``: fewer, because it does so every metre. ``near_fix``
    poses are compared around a GPS position. ``few_beams`` of a scan are enough to notice a place, by a
    likelihood field of ``wide_sigma`` metres: a pose beside the true one must be noticed, too. The ``kept``
    best, one of each bin of ``apart_m`` metres and ``apart_deg`` degrees, are tried ``tries`` times around,
    in two rounds, with standard deviations of ``rounds_m`` metres and ``rounds_deg`` degrees, by
    ``more_beams``. From these, poses are drawn by the filter's model of all beams.
    """

    per_area: Positive = 85.0
    most: Count = 1_500_000
    again_per_area: Positive = 12.0
    again_most: Count = 200_000
    near_fix: Count = 6_000
    few_beams: Count = 16
    more_beams: Count = 40
    wide_sigma: Positive = 0.5
    kept: Count = 500
    apart_m: Positive = 2.0
    apart_deg: Angle = 45.0
    tries: Count = 16
    rounds_m: tuple[Metres, Metres] = (0.3, 0.1)
    rounds_deg: tuple[Degrees, Degrees] = (6.0, 2.0)


class RecoverySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Recovery of a robot that does not know its place: table ``[filter.recovery]``.

    It is lost until it has driven ``settled`` metres at one place, updated by the wheels: another place may
    fit by chance for some metres, and façades repeat every few. It is at one place when ``share`` of the
    particles' weight is within ``place_m`` metres and ``place_deg`` degrees of the middle. Every
    ``look_every_m`` metres or ``look_every_scans`` scans it searches for other places, and puts
    ``new_particles`` of its particles there. If more than ``rival`` of the weight is at other places at the
    next search, another one fits equally well, and it is at none: ``accuracy`` must hold at 95 % of the
    scans. A scan has ``scan_worth`` of its usual weight: in each place the same walls are wrong scan after
    scan. Particles of one bin of ``group_m`` metres and ``group_deg`` degrees are resampled apart from
    others, ``group_least`` of each, in the ``most_groups`` heaviest, down to ``group_share`` of the weight:
    so none of several similar places dies out by chance.
    """

    settled: Metres = 15.0
    share: Share = 0.8
    rival: Share = 0.05
    place_m: Positive = 2.0
    place_deg: Angle = 30.0
    look_every_m: Metres = 1.0
    look_every_scans: Count = 10
    new_particles: Share = 0.1
    scan_worth: Share = 0.15
    group_m: Positive = 4.0
    group_deg: Angle = 45.0
    group_least: Count = 20
    group_share: Share = 1e-3
    most_groups: Count = 100


class FixSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Trust in GPS positions: table ``[filter.gps]``.

    ``wrong`` is the likelihood of a position however far away, relative to that of a correct one, 1: because
    of reflections at walls no place is excluded. The belief is wrong when ``against`` of the newest ``of``
    positions are more than ``far`` standard deviations from it: not all in a row, because a belief that
    drives the same alley the other way comes by the robot's true place. A position guides the search for
    ``lasts`` metres of driving.
    """

    wrong: Share = 1e-3
    far: Positive = 4.0
    against: Count = 2
    of: Count = 3
    lasts: Metres = 10.0

    def __post_init__(self) -> None:
        """Refuse impossible values."""
        if self.against > self.of:
            raise ValueError(f"against = {self.against} is more than of = {self.of}")


class StandingSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Standing robots, and the use of their scans: table ``[filter.standing]``.

    Less than ``still_m`` metres and ``still_rad`` radians between two scans is standing. While a robot stands
    and knows its place, one of every ``scans`` scans is weighed, as they all see the same, after spreading
    the particles by ``jitter_m`` and ``jitter_rad``. One that is lost counts each scan as ``scan_worth``
    metres of driving, within ``expected`` metres of where its wheels or GPS have it: elsewhere it may be in
    any of several similar places. It reports an accuracy of ``lost_accuracy`` metres at least, as wide as one
    place, and is lost if it knows its place no better. It sees nothing of its map if ``few_echoes`` beams or
    fewer have an echo. It stands ``border`` metres from the border of a map of a part of the site, when the
    filter is ``late`` seconds behind the sensors, and after a pause of more than ``pause`` seconds between
    readings or a motion ``jump`` metres or radians beyond what its body can do: the noise of sensors is less.
    """

    still_m: Metres = 1e-3
    still_rad: Radians = 1e-3
    scans: Count = 10
    jitter_m: Metres = 0.01
    jitter_rad: Radians = 0.005
    scan_worth: Metres = 0.1
    expected: Metres = 3.0
    lost_accuracy: Metres = 2.0
    few_echoes: Annotated[int, msgspec.Meta(ge=0, le=10_000)] = 3
    border: Metres = 2.0
    late: Positive = 1.0
    pause: Positive = 2.0
    jump: Metres = 0.3


class FilterSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The particle filter: motion, beams, number of particles, and when scans do not fit any more.

    ``distance_noise`` and ``slip`` are metres ahead and sideways, ``drift_deg`` degrees, for the square root
    of a metre, ``turn_noise`` is of the turn: standard deviations by which particles are spread.
    ``wheel_scale`` is by how much of the distance the wheels are wrong the same way all along (a standard
    deviation): no particle samples it, but the covariance includes its effect on the place. ``sigma`` is how
    far a beam may be from the map, metres, the map's own errors included; ``hit``, ``short``, ``far`` and
    ``random`` are the weights of the beam model's parts. ``beams_of_worth`` is the number of independent
    beams that a scan counts for: neighbouring beams see the same wall, whose place in the map is wrong for
    all of them. For the same reason the scans of ``same_walls`` metres of driving count as one. ``least`` to
    ``most`` particles, so many that with a probability of 99 % their error (Kullback-Leibler) is below
    ``kld_error`` over bins of ``bin_size`` metres and ``bin_turn_deg`` degrees. ``slow`` and ``fast`` are the
    rates at which the agreement of scans and map is averaged; particles are put where a scan fits once the
    fast average is below ``recover`` times the slow one. Below ``least_agreement`` the place is unknown,
    whatever the usual agreement. A beam agrees when it is within ``agrees`` times ``sigma`` of the map's
    obstacle. A likelihood field has cells of ``field_cell`` metres, larger ones if there would be more than
    ``field_cells``, and is uniform beyond ``field_sigmas`` times ``sigma`` from all walls, where hardly any
    beam on a wall ends.
    """

    model: Literal["beam", "field"] = "beam"
    distance_noise: Metres = 0.036
    turn_noise: Share = 0.05
    drift_deg: Degrees = 0.3
    slip: Metres = 0.01
    wheel_scale: Share = 0.01
    sigma: Positive = 0.15
    hit: Share = 0.6
    short: Share = 0.25
    far: Share = 0.05
    random: Share = 0.1
    beams_of_worth: Positive = 12.0
    same_walls: Positive = 2.0
    least: Annotated[int, msgspec.Meta(ge=10, le=100_000)] = 500
    most: Annotated[int, msgspec.Meta(ge=10, le=100_000)] = 10_000
    kld_error: Annotated[float, msgspec.Meta(gt=0, le=1)] = 0.05
    bin_size: Positive = 0.5
    bin_turn_deg: Annotated[float, msgspec.Meta(gt=0, le=360)] = 10.0
    slow: Share = 0.02
    fast: Share = 0.2
    recover: Share = 0.6
    least_agreement: Share = 0.3
    agrees: Positive = 3.0
    field_cell: Positive = 0.1
    field_sigmas: Positive = 4.0
    field_cells: Annotated[int, msgspec.Meta(ge=10_000, le=400_000_000)] = 40_000_000
    search: SearchSettings = SearchSettings()
    recovery: RecoverySettings = RecoverySettings()
    gps: FixSettings = FixSettings()
    standing: StandingSettings = StandingSettings()


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
