# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The positions of an encoder: their unit, where they wrap, and the angle without wraps."""

import math
from dataclasses import dataclass

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_step import Array, Step
from gear_kinematics.report.document import counted

_TURNS = {'rad': TURN, 'degrees': 360.0, 'turns': 1.0}
"""A turn in the units that positions may have."""
_UNCLEAR = 0.3, 0.7
"""Turns between samples that may be a motion or a wrap."""
_MOST_UNCLEAR = 0.05
"""Of such steps, as a share of the wraps, as in gaps: with more, there is no wrap at all."""
_SPAN_OF_WRAP = 0.8, 1.001
"""Turns within which positions are that wrap; the upper bound has room for noise and rounding."""
_SAME_TURN = 0.02
"""Share by which a turn that wraps show may differ from one of a unit, as the speed changes; an
encoder of 4000 counts differs from one of 4096 by 0.023."""
_MIN_LEVELS = 4
"""Whole numbers that show counts: fewer may be chance, as of an encoder at rest."""
_ROUNDING = 1e-5
"""Distance from whole numbers, of counts up to 10^10 that were divided into turns and a rest."""
_POWER = 1e-4
"""Distance of a logarithm to base 2 from an integer within which a number is a power of two: by
chance, the step of an encoder is in one of the units with a probability of 6e-4."""
_MIN_BITS = 6
"""Of an encoder."""
COUNTED = 1.05
"""Turns beyond which positions count turns: one turn, and room for noise."""


@dataclass(frozen=True, eq=False, slots=True)
class Positions:
    """What the positions of an encoder show of it."""

    unit: str
    """rad, degrees, turns or counts."""
    turn: float | None
    """Of them, in the unit; None: counts, of which a turn has an unknown number."""
    evidence: str
    """Of the unit, as a clause."""
    wraps: int
    """That were seen."""
    angle: Array
    """(n,), without wraps, rad; in counts where their number is unknown."""

    @property
    def turns(self) -> float:
        """From the least to the greatest angle."""
        return float(np.ptp(self.angle)) / TURN

    @property
    def fault(self) -> str:
        """What to do where the unit is not rad, as a clause; else empty."""
        if self.turn is None:
            return f'counts ({self.evidence}), of which a turn has an unknown number'
        if self.unit == 'rad':
            return ''
        return f'{self.unit} ({self.evidence}): multiply by {TURN / self.turn:.9g}'


def positions_of(values: Array, step: Step) -> Positions:
    """Find the unit and the wraps of positions.

    Args:
        values: (n,), in the order of time, as they were recorded.
        step: of the encoder, in the same unit.
    """
    span, steps, rounded = float(np.ptp(values)), np.diff(values), np.round(values)
    whole = np.abs(values - rounded).max() < _ROUNDING and len(np.unique(rounded)) >= _MIN_LEVELS
    counts = {'counts': 2.0 ** math.ceil(math.log2(span + 1.0))} if whole else {}
    low, high = _SPAN_OF_WRAP
    for unit, turn in (_TURNS | counts).items():
        size = np.abs(steps) / turn
        wraps = np.flatnonzero(size >= _UNCLEAR[1])
        unclear = np.count_nonzero((size > _UNCLEAR[0]) & (size < _UNCLEAR[1]))
        if not (len(wraps) and unclear <= _MOST_UNCLEAR * len(wraps)):
            continue
        # The motion goes on as before the wrap. Only counts may have any number in a turn.
        wrapped = float(np.median(size[wraps] + size[np.maximum(wraps - 1, 0)]))
        same = unit != 'counts' or abs(wrapped - 1.0) < _SAME_TURN
        if same and low < span / turn <= high:
            angle = values - turn * np.cumsum(np.round(np.diff(values, prepend=values[0]) / turn))
            evidence = f'{counted(len(wraps), "wrap")} at {turn:.9g}'
            return Positions(unit, turn, evidence, len(wraps), angle * (TURN / turn))
    if whole:
        return Positions('counts', None, 'whole numbers', 0, values)
    for unit, turn in _TURNS.items():
        bits = math.log2(turn / step.size) if step.seen else 0.0
        if round(bits) >= _MIN_BITS and abs(bits - round(bits)) < _POWER:
            seen = f'steps of 1/2^{round(bits)} turn'
            return Positions(unit, turn, seen, 0, values * (TURN / turn))
    return Positions('rad', TURN, 'nothing contradicts', 0, values)
