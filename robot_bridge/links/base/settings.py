"""The settings of a link: one TOML file, with a table for each of the link's parts."""

from __future__ import annotations

import difflib
import os
import re
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from ...core.json_decoder import toml_tables
from ...core.messages.base import ROBOT_NAME
from .errors import LinkError
from .frames import FrameSettings

URL = "ws://127.0.0.1:8765/link"
Table = TypeVar("Table", bound=msgspec.Struct)

LARGEST_FILE = 1 << 20
"""bytes."""


class GatewayAddressSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Table ``[gateway]``: the gateway's address, and the credentials; files are beside the settings."""

    url: str = ""
    token_file: str | None = None
    ca: str | None = None


class LinkSettings(msgspec.Struct, frozen=True):
    """Settings of every link; ``file`` is their file, and ``name`` its name without suffix.

    ``state_folder`` holds the record of executed messages. A robot's side has ``answer_within_s`` seconds to
    accept a command.
    """

    name: str
    file: Path
    gateway: GatewayAddressSettings
    frame: FrameSettings
    state_folder: Path
    answer_within_s: float = 10.0

    @property
    def folder(self) -> Path:
        """The folder to which file names in the settings are relative."""
        return self.file.resolve().parent

    @property
    def memory_file(self) -> Path:
        """The file of the link's memory."""
        return self.state_folder / f"{self.name}.state"

    def beside(self, name: str) -> Path:
        """Return the path of a file named in the settings."""
        return self.folder / name


def read_settings(file: Path, table: str, of: type[Table]) -> tuple[LinkSettings, Table]:
    """Return the settings of the link, and of its kind: the table ``[table]`` as ``of``.

    ``of`` is a msgspec.Struct with ``forbid_unknown_fields``.

    :raises LinkError: naming file and key.
    """
    tables = _tables(file)
    known = {"kind", "gateway", "frame", "state_folder", "answer_within_s", table}
    for key in tables:
        if key not in known:
            raise LinkError(f"{file}: {key} is not a setting{_near(key, known)}")
    if tables.get("kind", table) != table:
        raise LinkError(f"{file}: kind = {tables['kind']!r}, and it is run as one of kind {table}")
    own = tables.get(table, {})
    gateway = _convert(tables.get("gateway", {}), GatewayAddressSettings, file, "gateway")
    if not gateway.url:
        # The URL of the gateway that started this link, if one did.
        gateway = msgspec.structs.replace(gateway, url=os.environ.get("ROBOT_BRIDGE_LINK_URL", URL))
    if not re.fullmatch(r"wss?://[^/?#]+/link", gateway.url):
        raise LinkError(f"{file}: gateway.url = {gateway.url!r}: write it as ws://127.0.0.1:8765/link")
    settings = LinkSettings(
        name=_name(file),
        file=file,
        gateway=gateway,
        frame=_convert(tables.get("frame", {}), FrameSettings, file, "frame"),
        state_folder=_state_folder(tables, file),
        answer_within_s=_positive(tables, "answer_within_s", 10.0, file),
    )
    return settings, _convert(own, of, file, table)


def kind_in(file: Path) -> str:
    """Return the kind of link in the settings ``file``, key ``kind``; raises LinkError."""
    kind = _tables(file).get("kind")
    if not isinstance(kind, str):
        raise LinkError(f"{file}: kind is missing; write the kind of the link, as kind = 'tracker'")
    return kind


def _name(file: Path) -> str:
    name = file.stem
    if not ROBOT_NAME.fullmatch(name):
        raise LinkError(f"{file}: a link is called by its file's name; take letters, digits, '_', '.' or '-'")
    return name


def _state_folder(tables: dict[str, Any], file: Path) -> Path:
    given = tables.get("state_folder")
    if given is not None and not isinstance(given, str):
        raise LinkError(f"{file}: state_folder = {given!r}: write the path of a folder")
    beside = file.resolve().parent
    if given is not None:
        return beside / given
    surrounding = os.environ.get("ROBOT_BRIDGE_STATE") or os.environ.get("STATE_DIRECTORY")
    return Path(surrounding) if surrounding else beside


def _positive(tables: dict[str, Any], key: str, default: float, file: Path) -> float:
    value = tables.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value <= 600:
        raise LinkError(f"{file}: {key} = {value!r}: write seconds, above 0 and up to 600")
    return float(value)


def _tables(file: Path) -> dict[str, Any]:
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise LinkError(f"{file} has more than {LARGEST_FILE} bytes; it is no file of settings")
        return toml_tables(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise LinkError(f"{file} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    except ValueError as error:
        raise LinkError(f"{file} is not valid TOML: {error}. Correct that line.") from None


def _convert(content: Any, of: type[Table], file: Path, table: str) -> Table:
    try:
        return msgspec.convert(content, of)
    except msgspec.ValidationError as error:
        reason, _, place = str(error).partition(" - at `$")
        key = f"{table}{place.rstrip('`')}"
        unknown = re.fullmatch(r"Object contains unknown field `(.*)`", reason)
        if unknown is not None:
            known = {field.name for field in msgspec.structs.fields(of)}
            raise LinkError(
                f"{file}: {key}.{unknown[1]} is not a setting{_near(unknown[1], known)}"
            ) from None
        missing = re.fullmatch(r"Object missing required field `(.*)`", reason)
        if missing is not None:
            raise LinkError(f"{file}: {key}.{missing[1]} is missing") from None
        raise LinkError(f"{file}: {key}: {reason}") from None


def _near(key: str, known: set[str]) -> str:
    near = difflib.get_close_matches(key, known, n=1)
    hint = f"did you mean {near[0]}? Known are" if near else "known are"
    return f": {hint} {', '.join(sorted(known))}"
