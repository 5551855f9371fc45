"""How an optional Python package comes onto a computer: the remedy in errors about one that is missing."""

from __future__ import annotations

_DEBIAN = {
    "cbor2": "python3-cbor2",
    "PyYAML": "python3-yaml",
    "zstandard": "python3-zstandard",
}
_VERSIONS = {"shapely": "'shapely>=2,<2.1'"}
"""What pip is asked for where the newest version does not go with Debian 12's other packages."""


def installation(package: str) -> str:
    """Return how ``package`` is installed, to follow "install it"; Debian's Python refuses a plain pip."""
    elsewhere = f"python3 -m pip install {package}, with the Python that runs this"
    if debian := _DEBIAN.get(package):
        return f"(on Debian: apt install {debian}; elsewhere: {elsewhere})"
    wanted = _VERSIONS.get(package, package)
    pip = f"python3 -m pip install --user --break-system-packages {wanted}"
    return f"(on Debian: apt install python3-pip, then {pip}; elsewhere: {elsewhere})"
