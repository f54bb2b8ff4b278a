# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The states of a rotor that were found valid, as arrays."""

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.wire.batches import Array

_COLUMNS = np.dtype('i8, f8, f8, f8, f8, i8, i8, i8, ?')
"""Types of the fields of `RotorSamples`, without the last one."""
Row = tuple[RotorSample, int, int, int, bool]  # a sample, and its fields from `row` on


class RotorSamples(NamedTuple):
    """Valid rotor states as arrays (n,), and the stamps of rejected ones."""

    stamp: Array  # ns
    turns: Array
    angle: Array  # rad: the rotor angle φ2 is 2π turns + angle
    velocity: Array  # rad/s; NaN if the message has none
    effort: Array  # N·m; NaN if the message has none
    row: Array  # index of the message
    received: Array  # time of reception, ns
    segment: Array  # rises where the turn count restarts, is uncertain or is referenced
    referenced: Array  # whether the rotor's turns are known
    rejected: Array  # (m,), ns: the stamps of rejected messages that have one

    @property
    def rotor_angle(self) -> Array:
        """The rotor angle φ2, rad."""
        return TURN * self.turns + self.angle

    @classmethod
    def of(cls, rows: Sequence[Row], rejected: ArrayLike = ()) -> Self:
        """Join single samples; None becomes NaN."""
        columns = [(s.stamp, *s.position, s.velocity, s.effort, *others) for s, *others in rows]
        table = np.array(columns, _COLUMNS)
        values = (table[name].copy() for name in table.dtype.names or ())
        return cls._make([*values, np.array(rejected, np.int64)])
