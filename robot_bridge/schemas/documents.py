"""Every schema as a file: what ``robot-bridge schemas`` writes and the gateway serves under ``/schemas/``."""

from __future__ import annotations

import json
from functools import cache

from ..messages import ANSWERS, DESK_REQUESTS, REQUESTS
from .asyncapi import asyncapi
from .definitions import schema_of
from .links import link_documents
from .tables import HEADS, NOTIFICATIONS, RESULTS


@cache
def documents() -> dict[str, str]:
    """Return the text of each JSON document by its path, such as ``robot/SendPos.json``.

    ``robot`` holds what robots say, ``gateway`` what they are told, ``link`` what links say, ``link-gateway``
    what those are told, ``desk`` what operators ask, ``result`` what they are answered with, ``news`` what
    they are told unasked, and ``head`` what stands in the heads of binary frames; ``index.json`` lists them.
    """
    files = {f"robot/{op}.json": schema_of(cls, closed=True) for op, cls in REQUESTS.items()}
    files |= {f"gateway/{op}.json": schema_of(cls) for op, cls in ANSWERS.items()}
    files |= {f"desk/{method}.json": schema_of(cls, closed=True) for method, cls in DESK_REQUESTS.items()}
    files |= {f"result/{request.method}.json": schema_of(cls) for request, cls in RESULTS.items()}
    files |= {f"news/{method}.json": schema_of(cls) for method, cls in NOTIFICATIONS.items()}
    files |= {f"head/{method}.json": schema_of(cls) for method, cls in HEADS.items()}
    files |= link_documents()
    files["asyncapi.json"] = asyncapi()
    files["index.json"] = {"documents": sorted(files)}
    return {path: json.dumps(content, indent=2) + "\n" for path, content in files.items()}


def served(path: str) -> str | None:
    """Return the document at ``path`` of a URL, such as ``/schemas/asyncapi.json``; the index at its root."""
    if path in ("/schemas", "/schemas/"):
        return documents()["index.json"]
    return documents().get(path.removeprefix("/schemas/")) if path.startswith("/schemas/") else None
