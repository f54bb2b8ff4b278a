# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The states of a rotor that were found valid, as arrays."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np

from gear_kinematics.wire.batches import Array

_COLUMNS = np.dtype('i8, f8, f8, f8, f8, i8, i8, i8, ?')
"""Types of the fields of `RotorSamples`, without the last one."""


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

    @classmethod
    def of(cls, rows: Sequence[tuple[Any, ...]], rejected: Array) -> Self:
        """Make them of samples one by one; None becomes NaN."""
        table = np.array(rows, _COLUMNS)
        return cls._make([*(table[name].copy() for name in table.dtype.names or ()), rejected])
