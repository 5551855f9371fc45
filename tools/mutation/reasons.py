"""Why a mutant may live: ``survivors.toml``, which says so of each change that no test can or need notice."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import tomllib

from tools.mutation.findings import Mutant

FILE = Path(__file__).with_name("survivors.toml")


class ReasonError(Exception):
    """A reason is given for what is no mutant any more, or none is given; the text says which."""


class Reasons:
    """The reasons by the change that they are for.

    In the file each has a ``module``, a ``function``, the line that ``was``, what it ``becomes`` (several in
    a list) and the ``reason``. Lines are spelt as ast.unparse does.
    """

    def __init__(self, file: Path = FILE) -> None:
        self._reasons: dict[tuple[str, str, str, str], str] = {}
        for entry in tomllib.loads(file.read_text(encoding="utf-8")).get("survivor", []):
            if not entry.get("reason", "").strip():
                raise ReasonError(f"{file.name}: {entry['function']}: {entry['was']}: give a reason")
            becomes = entry["becomes"]
            for one in [becomes] if isinstance(becomes, str) else becomes:
                self._reasons[entry["module"], entry["function"], entry["was"], one] = entry["reason"]

    def of(self, mutant: Mutant) -> str | None:
        """Return why a mutant may live, None where nobody said why."""
        return self._reasons.get(mutant.change)

    def check(self, mutants: Sequence[Mutant]) -> None:
        """Raise ReasonError where a reason is given for a change that mutmut does not make."""
        gone = self._reasons.keys() - {mutant.change for mutant in mutants}
        if gone:
            told = "\n".join(
                f"  {module} {function}: {was} -> {one}" for module, function, was, one in sorted(gone)
            )
            raise ReasonError(f"{FILE.name} has reasons for what is no mutant; take them out:\n{told}")
