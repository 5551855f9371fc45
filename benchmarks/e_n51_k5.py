"""E-n51-k5: fifty customers of Christofides and Eilon (1969), with the optimum that is proven, 521.

N. Christofides and S. Eilon, An algorithm for the vehicle-dispatching problem, Operational Research Quarterly
20(3), 1969. Distances are Euclidean, rounded to whole numbers.
"""

from __future__ import annotations

import numpy as np

OPTIMUM = 521
CAPACITY = 160
DEPOT = (30, 40)
CUSTOMERS = """\
37 52 7, 49 49 30, 52 64 16, 20 26 9, 40 30 21, 21 47 15, 17 63 19, 31 62 23, 52 33 11, 51 21 5,
42 41 19, 31 32 29, 5 25 23, 12 42 21, 36 16 10, 52 41 15, 27 23 3, 17 33 41, 13 13 9, 57 58 28,
62 42 8, 42 57 8, 16 57 16, 8 52 10, 7 38 28, 27 68 7, 30 48 15, 43 67 14, 58 48 6, 58 27 19,
37 69 11, 38 46 12, 46 10 23, 61 33 26, 62 63 17, 63 69 6, 32 22 9, 45 35 15, 59 15 14, 5 6 7,
10 17 27, 21 10 13, 5 64 11, 30 15 16, 39 10 10, 32 39 5, 25 32 25, 25 55 17, 48 28 18, 56 37 10"""
"""x, y and demand of each."""


def customers() -> list[tuple[float, float, int]]:
    """Return x, y and demand of each customer."""
    rows = [[int(value) for value in row.split()] for row in CUSTOMERS.split(",")]
    return [(float(x), float(y), demand) for x, y, demand in rows]


def rounded(metres: np.ndarray) -> np.ndarray:
    """Return ``metres`` as the instance counts them."""
    return np.floor(metres + 0.5)
