"""What memory this process has, and what of it is in use."""

from __future__ import annotations

import ctypes
from pathlib import Path

from osgeo import gdal

_PARTS = ("RssAnon", "RssFile", "RssShmem")


class _Mallinfo(ctypes.Structure):
    """glibc's ``struct mallinfo2``."""

    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd")] + [
        (name, ctypes.c_size_t) for name in ("usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")
    ]


def megabytes() -> tuple[float, float]:
    """Return the memory that the system has given to this process, and what of it is of files and shared."""
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    kilobytes = {
        name: float(rest.split()[0])
        for name, _, rest in (line.partition(":") for line in lines)
        if name in _PARTS
    }
    own, *others = (kilobytes[name] * 1.024e-3 for name in _PARTS)
    return own + sum(others), sum(others)


def megabytes_in_use() -> float:
    """Return what the process has asked for and not given back, as glibc counts it in all of its arenas.

    What it has beyond that is free, and kept for later.
    """
    libc = ctypes.CDLL("libc.so.6")
    libc.mallinfo2.restype = _Mallinfo
    info = libc.mallinfo2()
    return (info.uordblks + info.hblkhd) / 1e6


def megabytes_of_rasters() -> float:
    """Return what GDAL keeps of rasters that were read, of whatever layer."""
    return gdal.GetCacheUsed() / 1e6
