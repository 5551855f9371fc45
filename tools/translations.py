"""Bring resources/translations up to date with the source: every text in every .ts, then the .qm for QGIS.

Texts that are gone are taken out; translations that are there stay. What has none yet is marked unfinished.

python -m tools.translations
"""

from __future__ import annotations

import argparse
import ast
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tools.syntax import tree_of

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "resources" / "translations"
CONTEXT = "FleetSupervisor"
FORMS = {"ca": 2, "es": 2, "hu": 1}
"""The languages, and into how many forms each puts a number of things, as Qt counts them."""
HEAD = b'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n'
CALLS = {"tr": 0, "tr_count": 2, "tr_page": 0}
"""What takes a text that is translated, and which of its arguments that is."""


class TranslationsError(Exception):
    """The translations cannot be made; the text says where and what to do."""


@dataclass(frozen=True)
class Text:
    """A text in the source: where it stands first, and whether it is about a number of things."""

    source: str
    place: str
    counted: bool


def texts(root: Path = ROOT) -> dict[str, Text]:
    """Return what the plugin shows people, by its English, in the order of the source files.

    :raises TranslationsError: when a text is put together where it is translated, so that nobody can know it.
    """
    found: dict[str, Text] = {}
    for path in sorted((root / "plugin").rglob("*.py")):
        if "vendor" not in path.parts:
            for text in _texts_of(path, path.relative_to(root).as_posix()):
                found.setdefault(text.source, text)
    return found


def _texts_of(path: Path, name: str) -> Iterator[Text]:
    for node in ast.walk(tree_of(path.read_text(encoding="utf-8"))):
        called = getattr(node.func, "id", "") if isinstance(node, ast.Call) else ""
        if called not in CALLS:
            continue
        argument = node.args[CALLS[called]]
        place = f"{name}:{node.lineno}"
        if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
            source = " ".join(argument.value.split()) if called == "tr_page" else argument.value
            yield Text(source, place, called == "tr_count")
        elif isinstance(argument, (ast.JoinedStr, ast.BinOp)):
            raise TranslationsError(f"{place}: write the text as one literal with {{placeholders}}")


def merged(known: ET.Element | None, language: str, wanted: dict[str, Text]) -> ET.Element:
    """Return the .ts of ``language`` that holds exactly ``wanted``, with the translations of ``known``."""
    done = {} if known is None else {_text(message, "source"): message for message in known.iter("message")}
    top = ET.Element("TS", version="2.1", language=language, sourcelanguage="en")
    context = ET.SubElement(top, "context")
    ET.SubElement(context, "name").text = CONTEXT
    for text in sorted(wanted.values(), key=lambda text: (text.place.split(":")[0], text.source)):
        message = ET.SubElement(context, "message", {"numerus": "yes"} if text.counted else {})
        ET.SubElement(message, "location", filename=f"../../{text.place.split(':')[0]}")
        ET.SubElement(message, "source").text = text.source
        before = done.get(text.source)
        if before is not None and (before.get("numerus") == "yes") == text.counted:
            message.append(before.find("translation"))
        else:
            _add_unfinished(message, FORMS[language] if text.counted else 0)
    ET.indent(top, "    ")
    return top


def _add_unfinished(message: ET.Element, forms: int) -> None:
    translation = ET.SubElement(message, "translation", type="unfinished")
    for _form in range(forms):
        ET.SubElement(translation, "numerusform")


def _text(message: ET.Element, tag: str) -> str:
    return message.findtext(tag) or ""


def ts_file(language: str) -> Path:
    """Return where the translations into ``language`` are."""
    return FOLDER / f"fleet_supervisor_{language}.ts"


def update() -> int:
    """Write every .ts and .qm anew; return how many translations are unfinished."""
    wanted = texts()
    unfinished = 0
    for language in FORMS:
        path = ts_file(language)
        known = ET.parse(path).getroot() if path.exists() else None
        top = merged(known, language, wanted)
        left = len(top.findall(".//translation[@type='unfinished']"))
        path.write_bytes(HEAD + ET.tostring(top, "utf-8") + b"\n")
        release(path, path.with_suffix(".qm"))
        print(f"{path.relative_to(ROOT)}: {len(wanted)} texts, {left} unfinished")
        unfinished += left
    return unfinished


def release(source: Path, target: Path) -> None:
    """Make the .qm that Qt reads from a .ts."""
    try:
        command = ["lrelease", "-silent", source, "-qm", target]
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError:
        raise TranslationsError(
            "lrelease is not there: install qttools5-dev-tools (Debian) or your system's Qt Linguist tools"
        ) from None
    except subprocess.CalledProcessError as error:
        raise TranslationsError(f"{source}: {error.stderr.strip() or error.stdout.strip()}") from error


def main() -> int:
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    try:
        return 1 if update() else 0
    except TranslationsError as error:
        print(f"translations: error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
