"""Random fields that look grown, worn or weathered; each repeats for its generator's seed."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from .canvas import METRES_PER_PIXEL


def blotches(
    rng: np.random.Generator, shape: tuple[int, int], size: float, stretch: float = 1.0
) -> np.ndarray:
    """Return a smooth field of mean 0 and deviation 1; ``size`` is in metres, ``stretch`` along the rows."""
    step = max(1.0, size / METRES_PER_PIXEL / 2)
    rows = int(np.ceil(shape[0] / step)) + 3
    columns = int(np.ceil(shape[1] / (step * stretch))) + 3
    coarse = rng.standard_normal((rows, columns)).astype(np.float32)
    if step > 1:
        coarse = ndimage.zoom(coarse, (step, step * stretch), order=2, mode="reflect")
    field = coarse[: shape[0], : shape[1]]
    return (field - field.mean()) / field.std()


def clouds(
    rng: np.random.Generator, shape: tuple[int, int], size: float, octaves: int = 4, fall: float = 0.6
) -> np.ndarray:
    """Return a sum of :func:`blotches` of ``size``, half of it, ... with mean 0 and deviation 1."""
    field = sum(fall**k * blotches(rng, shape, size / 2**k) for k in range(octaves))
    return (field / field.std()).astype(np.float32)


def between(low: tuple, high: tuple, share: np.ndarray) -> np.ndarray:
    """Return an RGB array that goes from colour ``low`` at share 0 to ``high`` at 1."""
    share = np.clip(share, 0, 1)[..., None].astype(np.float32)
    return np.asarray(low, np.float32) * (1 - share) + np.asarray(high, np.float32) * share
