# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean and standard error of correlated series."""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def blocked_mean(values: ArrayLike) -> tuple[float, float]:
    """Mean of a correlated series and the standard error of that mean, by blocking.

    values: shape (n,); those that are not finite are left out, and at least two must remain.
    Block size: the smallest B with B^3 > 2 n (error_B / error_1)^4; without such a B the largest error met, which is
    then a lower bound.
    Source: Lee et al., Phys. Rev. E 83, 066706 (2011).
    \\throws ValueError for fewer than two values.
    """
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    n = len(values)
    if n < 2:
        raise ValueError(f"blocking: {n} values; at least 2 are needed")
    mean = float(values.mean())
    blocks, size, best = values, 1, 0.0
    first = error = float(blocks.std() / np.sqrt(n - 1))
    while True:
        best = max(best, error)
        if len(blocks) // 2 < 8:
            return mean, best
        even = len(blocks) // 2 * 2
        blocks = 0.5 * (blocks[0:even:2] + blocks[1:even:2])
        size *= 2
        error = float(blocks.std() / np.sqrt(len(blocks) - 1))
        inflation = error / first if first > 0 else 1.0
        if size**3 > 2 * n * inflation**4:
            return mean, error
