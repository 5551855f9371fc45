"""What can be seen in the QGIS window: asks the reporter inside it, which acts on nothing."""

from __future__ import annotations

import json
import socket
from pathlib import Path
from typing import Any

from tests.support.errors import StageError

ANSWER_S = 60.0
"""How long QGIS may be busy before an answer."""


class Window:
    """The connection to the reporter at the local socket ``path``."""

    def __init__(self, path: Path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(ANSWER_S)
        self._socket.connect(str(path))
        self._lines = self._socket.makefile("rb")

    def close(self) -> None:
        """Ask no more."""
        self._lines.close()
        self._socket.close()

    def ask(self, question: str, **about: object) -> Any:
        """Return the reporter's answer to one of its questions.

        :raises StageError: when it has none, or QGIS does not answer.
        """
        try:
            self._socket.sendall(json.dumps({"ask": question, **about}).encode() + b"\n")
            line = self._lines.readline()
        except OSError as error:
            raise StageError(f"QGIS did not say {question} {about or ''}: {error}") from error
        if not line:
            raise StageError(f"QGIS ended when it was asked {question} {about or ''}")
        answer = json.loads(line)
        if "error" in answer:
            raise StageError(f"inside QGIS: {answer['error']}")
        return answer["answer"]
