"""The demonstration's short report: what happened and what was measured, as Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tests.support.map_export import ExportedMap
from tests.support.verdict import Outcome

PAPER_BYTES_PER_M2 = 3.0


@dataclass
class Report:
    """Collects what is to be written down."""

    versions: Mapping[str, str]
    steps: list[tuple[float, str]] = field(default_factory=list)
    exported: ExportedMap | None = None
    outcomes: Sequence[Outcome] = ()

    def text(self) -> str:
        """Return the report."""
        title = "# Fleet Supervisor: demonstration"
        parts = [title, self._versions(), self._steps(), self._map(), self._fleet()]
        return "\n\n".join(part for part in parts if part) + "\n"

    def _versions(self) -> str:
        return ", ".join(f"{name} {version}" for name, version in self.versions.items())

    def _steps(self) -> str:
        rows = [f"| {at:5.1f} | {text} |" for at, text in self.steps]
        return "\n".join(["## What happened", "", "| s | |", "|---:|---|", *rows])

    def _map(self) -> str:
        done = self.exported
        if done is None:
            return ""
        rows = [
            f"| text | {done.text_bytes} | {done.text_bytes / done.area:.3f} |",
            f"| binary | {done.binary_bytes} | {done.binary_bytes / done.area:.3f} |",
            f"| the paper's campus, text | | {PAPER_BYTES_PER_M2:g} |",
        ]
        head = f"{done.obstacles} obstacles, {done.segments} segments, {done.area:g} m²"
        table = ["| format | bytes | bytes/m² |", "|---|---:|---:|", *rows]
        return "\n".join(["## The robot map", "", f"The whole sample site: {head}.", "", *table])

    def _fleet(self) -> str:
        titles = "| robot | delivered | acknowledged | end | how | off target |"
        rows = [_row(outcome) for outcome in self.outcomes]
        note = "Seconds after `queued` by the gateway's clock; metres from the target at the end."
        return "\n".join(["## The commands", "", note, "", titles, "|---|---:|---:|---:|---|---:|", *rows])


def _row(outcome: Outcome) -> str:
    after, how = outcome.after, outcome.errand.outcome
    off = "" if outcome.off_target is None else f"{outcome.off_target:.2f} m"
    times = f"{after['delivered']:.2f} | {after['acknowledged']:.2f} | {after[how]:.2f}"
    return f"| {outcome.errand.robot} | {times} | {how} | {off} |"
