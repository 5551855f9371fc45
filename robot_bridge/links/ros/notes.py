"""What a link of ROS robots keeps of each for its next process: one file, written whole."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from ...core.decoding import DecodingError, decode_json

log = logging.getLogger(__name__)

Note = TypeVar("Note")


class RobotNotes:
    """A file of notes by robot. A full disk ends no link, which stops its robots there, too.

    ``fault`` says why the newest notes are not in the file, None where they are.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self.fault: str | None = None

    def read(self, decode: Callable[[Any], Note]) -> dict[str, Note]:
        """Return the notes of an earlier process; none where that cannot be read.

        ``decode`` raises ValueError, TypeError or KeyError for a note that is none.
        """
        try:
            known = decode_json(self._file.read_bytes())
            return {str(robot): decode(note) for robot, note in known.items()}
        except FileNotFoundError:
            return {}
        except (OSError, DecodingError, ValueError, AttributeError, TypeError, KeyError) as error:
            log.warning("%s is left out: %s", self._file, error)
            return {}

    def write(self, notes: Mapping[str, Any]) -> None:
        """Write notes in place of what was; what is wrong with that is logged once, and kept as ``fault``."""
        new = self._file.with_name(f"{self._file.name}.new")
        try:
            new.write_text(json.dumps(notes), encoding="utf-8")
            new.replace(self._file)
        except OSError as error:
            fault = f"{self._file} cannot be written: {error.strerror or error}"
            if self.fault is None:
                log.error("%s", fault)
            self.fault = fault
        else:
            self.fault = None
