"""The part on links: many robots over one connection, and each adapter beside what its robots speak."""

from __future__ import annotations

from pathlib import Path

from benchmarks import link_cost, link_replay, link_ros2, link_vda5050
from benchmarks.load import MALLOC
from benchmarks.page import Part


def measure(data: Path) -> Part:
    """Measure on the sample site; what cannot be had on this machine is said to be missing."""
    sections = (
        link_cost.section(),
        link_ros2.section(),
        link_vda5050.section(),
        link_replay.section(data),
    )
    return Part("Links", "\n\n".join(text.strip() for text in sections), settings=MALLOC)
