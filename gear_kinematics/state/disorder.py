# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tells a clock that was set back from messages that are late, by stamps that are out of order."""

from itertools import pairwise

import numpy as np

from gear_kinematics.wire.batches import Array, once_for_joints


class Disorder:
    """Collects the stamps, ns, that are older than that of the last sample."""

    def __init__(self) -> None:
        self.stamps: list[int] = []

    def set_back(self, last: int, stamp: int) -> int:
        """Return by how much the clock was set back between two samples, ns; forget the stamps.

        It was set back if several messages in a row, in order, were older than the last sample.
        """
        stamps, self.stamps = self.stamps, []
        rising = len(stamps) > 1 and all(a < b for a, b in pairwise([*stamps, stamp]))
        return last - stamps[0] if rising else 0


@once_for_joints
def order(stamps: Array) -> tuple[bool, int]:
    """Return whether stamps never fall and none is 0, and how many repeat the one before."""
    steps = np.diff(stamps)
    return bool((steps >= 0).all() and stamps.all()), int(np.count_nonzero(steps == 0))
