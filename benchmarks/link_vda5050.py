"""VDA 5050 vehicles that tell their state, through a broker and the adapter."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.clock import table
from benchmarks.linked import HERE, PROBING, START, Linked, NotMeasuredError, linked
from benchmarks.trial import size
from tests.support.databases.database_server import find_program
from tests.support.errors import StageError
from tests.support.processes import Processes, free_port

VEHICLES, RATE = size(200, 10), 1.0
SECONDS = size(90.0, 6.0)
HEAD = ("vehicles", "delay to the desk, ms: median", "p99", "adapter's CPU", "gateway's CPU")
TEXT = """\
### VDA 5050

{vehicles} vehicles of one process tell their whole state at {rate:g} Hz to a mosquitto on this machine, each
message with the fields that the standard asks for. The delay is from the state's time stamp to a desk at
{desk:g} Hz; of {seconds:g} s.

{rows}
"""


def section() -> str:
    """Return what was measured, as Markdown."""
    try:
        with driving(VEHICLES, RATE) as link:
            link.wait_for(VEHICLES)
            link.look()
            window = link.window(SECONDS)
    except (StageError, NotMeasuredError) as error:
        return f"### VDA 5050\n\n**Not measured**: {error}"
    rows = table(HEAD, [[f"{VEHICLES} × {RATE:g} Hz", *window.row()]])
    return TEXT.format(vehicles=VEHICLES, rate=RATE, seconds=SECONDS, desk=PROBING, rows=rows)


@contextmanager
def driving(vehicles: int, rate: float) -> Iterator[Linked]:
    """Let so many vehicles say their state at ``rate`` Hz to a broker, an adapter and its gateway."""
    with (
        _broker() as (processes, port),
        linked("vda5050", f'[vda5050]\nbroker = "mqtt://127.0.0.1:{port}"\n') as link,
    ):
        crowd = [sys.executable, HERE / "vda_crowd.py", str(port), str(vehicles), str(rate)]
        processes.start("crowd", crowd)
        yield link


@contextmanager
def _broker() -> Iterator[tuple[Processes, int]]:
    program, port = find_program("mosquitto", "/usr/sbin"), free_port()
    with tempfile.TemporaryDirectory() as name, Processes(Path(name) / "logs") as processes:
        settings = Path(name) / "mosquitto.conf"
        lines = [f"listener {port} 127.0.0.1", "allow_anonymous true", "persistence false"]
        if os.geteuid() == 0:
            lines.append("user root")  # its own account may not read the folder
        settings.write_text("\n".join(lines) + "\n", "utf-8")
        processes.start("broker", [program, "-v", "-c", settings])
        processes.wait_for_line("broker", r"mosquitto version .* running", START)
        yield processes, port
