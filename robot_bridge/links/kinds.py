"""The kinds of links. A kind is imported on demand: none needs the packages of others."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from .base.adapter import Adapter
from .base.errors import LinkError
from .base.settings import LinkSettings


@dataclass(frozen=True)
class Kind:
    """A kind of link: ``module`` has ``load(file)``, which returns its settings and its adapter.

    ``extra`` is this project's optional extra that it needs, as named to pip.
    """

    module: str
    help: str
    extra: str | None = None


KINDS = {
    "replay": Kind("replay.adapter", "Recorded drives: seen, marked as replay, and not commanded."),
    "ros2": Kind("ros2.adapter", "ROS 2 robots, with or without Nav2, over DDS.", extra="ros2"),
    "rosbridge": Kind(
        "rosbridge.adapter", "ROS 2 robots behind a rosbridge server, over WebSocket.", extra="rosbridge"
    ),
    "tracker": Kind("tracker.adapter", "Phones and GPS receivers: seen, and not commanded."),
    "vda5050": Kind("vda5050.adapter", "Vehicles that speak VDA 5050, over an MQTT broker.", "vda5050"),
}
"""Kinds by their names on the command line and in the settings."""


def load(kind: str, file: Path) -> tuple[LinkSettings, Adapter]:
    """Return the settings in ``file`` of a link of ``kind``, and its adapter.

    :raises LinkError: for settings that cannot be used, and for a package that is missing.
    """
    found = KINDS.get(kind)
    if found is None:
        raise LinkError(f"{file}: {kind!r} is no kind of link; known are {', '.join(KINDS)}")
    try:
        module = import_module(f".{found.module}", __package__)
        loaded: tuple[LinkSettings, Adapter] = module.load(file)
    except ImportError as error:
        if found.extra is None or error.name is None or error.name.startswith(__package__.split(".")[0]):
            raise
        raise LinkError(
            f"a link of kind {kind} needs the Python package {error.name}, which is missing; install it "
            f"with: pip install 'fleet-supervisor-robot-bridge[{found.extra}]'"
        ) from None
    return loaded
