"""Hold what is asked of QGIS and Qt against the stubs of QGIS 4 on Qt 6, by mypy.

The stubs (qgis-stubs, and those that PyQt6 brings) are made of the bindings: what they do not have, QGIS 4
has not, and what they want an int for takes no float. Of what mypy says only that counts: how the plugin's
own parts fit together is not asked here, nor whether QGIS may answer None.

    python -m tools.qgis4_types
"""

from __future__ import annotations

import os
import re
import site
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGE = "fleet_supervisor"
PROGRAMS = ("resources/styles", "resources/sample_site")
"""Folders of programs that use QGIS beside the plugin."""
_MOVED = {"QtWidgets": "from PyQt6.QtGui import QAction, QActionGroup, QShortcut\n"}
"""What qgis.PyQt keeps where Qt 5 had it."""
_LINE = re.compile(r"(?P<place>[^:]+:\d+): error: (?P<text>.*)  \[(?P<code>[a-z-]+)\]")
_CLASS = r"(?:Qgis|Q[A-Z]\w+|Qgs\w+)"
_OF_QT_OR_QGIS = re.compile(
    rf'^(?:Item )?"(?P<owner>{_CLASS}|type\[\w+\])"(?: of "[^"]*")? has no attribute "(?P<name>\w+)"'
    r'|^Module "(?:qgis|PyQt6)[\w.]*" has no attribute'
    rf'| (?:to|for|of|variant of) "{_CLASS}"'
    r"|^Non-overlapping equality check"
)
"""What mypy says of a name or an argument of QGIS or Qt."""
_OPERATION = re.compile(
    r'^Unsupported (?:left )?operand types? for |^No overload variant of "(?:int|float|bool|range)" matches'
    r"|^Value of type |^Non-overlapping container check"
)
"""What mypy says of an operation; the classes in quotes tell whether QGIS or Qt has to do with it."""
_QUOTED_CLASS = re.compile(r'"(\w+)"')
_ENUM = re.compile(r"^ +class (\w+)\(enum\.(?:Enum|Flag)\)", re.MULTILINE)
"""An enum whose values are no int."""
_ADDED = re.compile(
    r"^(?:\w+\.)*(?P<owner>\w+)\.(?P<name>\w+) = (?:lambda|(?:\w+\.)*?(?P<enum>\w+)\.\w+$)", re.MULTILINE
)
"""How QGIS adds names to its classes in Python: old names of an enum's values above all, unseen by mypy."""
_METHOD = re.compile(r"^ +def (\w+)\(", re.MULTILINE)
_STUBS = ("qgis/", "PyQt6/")
_HANDED_OUT_AS_BASE = {"QEvent", "QgsMapLayerTemporalProperties", "QgsMapTool", "QgsSymbolLayer"}
"""Classes in whose place PyQt hands out the class that the object really is."""
_WORKS = (
    "does not return a value",  # nothing of QGIS or Qt is wrong when its None is used
    '"Mapping[str, Any]"; expected "dict[',  # what QGIS hands in as parameters is a dict
    # These have been run on PyQt6: see test_what_the_stubs_do_not_know_works.
    '"drawLines" of "QPainter" matches argument type "list[QLineF]"',
    '"__rshift__" of "QDataStream" matches argument type "QPainterPath"',
    '"QImage" matches argument types "memoryview[int]"',
    '"loadFromData" of "QTranslator" has incompatible type "bytes"',
)


def complaints(root: Path, *further: Path) -> list[str]:
    """Return ``file:line: text`` of what QGIS 4 on Qt 6 does not have or does not take.

    Looked at are the plugin whose folder is ``root``, the programs beside it, and the modules in ``further``
    folders. What mypy knows of the stubs it keeps below ``root``, in build.
    """
    folders = [*(root / folder for folder in PROGRAMS), *further]
    modules = [path.stem for folder in folders for path in sorted(folder.glob("*.py"))]
    cache = root / "build" / "mypy-qgis4"
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / PACKAGE).symlink_to(root, target_is_directory=True)
        _lay_out_stubs(Path(place))
        done = subprocess.run(
            [
                Path(sys.executable).with_name("mypy"),
                *(
                    "--config-file",
                    os.devnull,
                    "--cache-dir",
                    cache,
                    "--no-error-summary",
                    "--hide-error-context",
                ),
                *(
                    "--check-untyped-defs",
                    "--strict-equality",
                    "--no-strict-optional",
                    "--ignore-missing-imports",
                ),
                *("--follow-imports", "silent", "--package", f"{PACKAGE}.plugin"),
                *(part for module in modules for part in ("--module", module)),
            ],
            env={**os.environ, "MYPYPATH": os.pathsep.join([place, *map(str, folders)])},
            cwd=place,
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode not in (0, 1):
        raise RuntimeError(f"mypy could not look: {done.stdout}{done.stderr}")
    known = _Known()
    return [text for line in done.stdout.splitlines() if (text := _of_qgis(line, known))]


class _Known:
    """What QGIS 4 and Qt 6 have beside what mypy sees: names added in Python, and names of any class."""

    def __init__(self) -> None:
        additions = (_installed("qgis-stubs") / "core" / "__init__.py").read_text(encoding="utf-8")
        self.added = set()
        for found in _ADDED.finditer(additions):
            self.added |= {(found["owner"], found["name"]), (found["enum"], found["name"])}
        stubs = [*_installed("qgis-stubs").glob("*.pyi"), *_installed("PyQt6").glob("*.pyi")]
        texts = [stub.read_text(encoding="utf-8") for stub in stubs]
        self.anywhere = {name for text in texts for name in _METHOD.findall(text)}
        self.enums = {name for text in texts for name in _ENUM.findall(text)}

    def has_class(self, name: str) -> bool:
        """Tell whether QGIS or Qt has a class, or an enum that is no int, of this name."""
        return name in self.enums or re.fullmatch(_CLASS, name) is not None


def _of_qgis(line: str, known: _Known) -> str:
    """Return what mypy's line says of QGIS or Qt, and nothing when it says nothing of them that is true."""
    found = _LINE.fullmatch(line)
    if not found or found["place"].startswith(_STUBS) or any(text in found["text"] for text in _WORKS):
        return ""
    told = f"{found['place']}: {found['text']}"
    if _OPERATION.search(found["text"]):
        return told if any(map(known.has_class, _QUOTED_CLASS.findall(found["text"]))) else ""
    asked = _OF_QT_OR_QGIS.search(found["text"])
    if not asked:
        return ""
    owner, name = (asked["owner"] or "").removeprefix("type[").removesuffix("]"), asked["name"]
    if (owner, name) in known.added or (owner in _HANDED_OUT_AS_BASE and name in known.anywhere):
        return ""
    return told


def _lay_out_stubs(place: Path) -> None:
    """Put a package qgis into ``place``: the stubs, on the installed PyQt6, arranged as QGIS does."""
    (place / "PyQt6").symlink_to(_installed("PyQt6"), target_is_directory=True)
    qgis = place / "qgis"
    (qgis / "PyQt").mkdir(parents=True)
    for part in _installed("qgis-stubs").iterdir():
        if part.name not in ("PyQt", "__pycache__"):
            (qgis / part.name).symlink_to(part, target_is_directory=part.is_dir())
    (qgis / "PyQt" / "__init__.pyi").touch()
    for module in sorted(_installed("PyQt6").glob("*.pyi")):
        text = f"from PyQt6.{module.stem} import *\n" + _MOVED.get(module.stem, "")
        (qgis / "PyQt" / module.name).write_text(text, encoding="utf-8")


def _installed(package: str) -> Path:
    for folder in site.getsitepackages():
        if (Path(folder) / package).is_dir():
            return Path(folder) / package
    raise RuntimeError(f"{sys.executable} has no {package}: run make setup")


if __name__ == "__main__":
    found = complaints(Path(__file__).resolve().parents[1])
    print("\n".join(found) or "QGIS 4 on Qt 6 has all that is asked of it")
    sys.exit(bool(found))
