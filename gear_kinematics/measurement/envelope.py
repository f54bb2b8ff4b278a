# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Lines with no more points than a plot shows."""

import numpy as np

from gear_kinematics.report.document import Array

MOST = 2000  # points of a line


def envelope(x: Array, y: Array) -> tuple[Array, Array]:
    """Reduce points that are too dense for a plot to their minima and maxima."""
    order = np.argsort(x, kind='stable')
    x, y = x[order], y[order]
    if len(x) <= MOST:
        return x, y
    starts = np.linspace(0, len(x), MOST // 2, endpoint=False, dtype=np.intp)
    bounds = np.stack([np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)], axis=1)
    return np.repeat(x[starts], 2), bounds.ravel()
