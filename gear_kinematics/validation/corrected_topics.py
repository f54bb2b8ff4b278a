# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the topics of the corrected output with recomputed ones, sample by sample.

The hysteresis depends on the motion before the recording. What another history would change is
accepted, until the output has travelled far enough; see `Correction.unknown_history`.
"""

from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.fields import Array, Window
from gear_kinematics.validation.output_topics import STATE_UNITS, Bounds, JointStateTopic
from gear_kinematics.validation.recorder import HOLE
from gear_kinematics.wire.topics import CORRECTED_INTERVAL, CORRECTED_STATE


class Unbroken:
    """Numbers the segments of a recording; holes end them too, as history is then unknown."""

    def __init__(self) -> None:
        self._last: int | None = None
        self._holes = 0

    def segments(self, stamp: Array, segment: Array) -> Array:
        """Return the segments of the next samples, (n,)."""
        first = stamp[:1] if self._last is None else self._last
        period = np.diff(stamp, prepend=first)
        forward = period > 0
        after_hole = period > HOLE * np.median(period[forward]) if forward.any() else forward
        holes = self._holes + np.cumsum(after_hole)
        if len(stamp):
            self._last, self._holes = int(stamp[-1]), int(holes[-1])
        return np.asarray(segment + holes)


class CorrectedState(JointStateTopic):
    """corrected_state; samples have the fields of `Correction`, too."""

    units: ClassVar[Mapping[str, str]] = STATE_UNITS

    def _expected(self, samples: Window) -> Sequence[Bounds]:
        position = self._ideal_angle(samples) + samples['deviation']
        history = samples['unknown_history']
        ratio = self._gear.gear_ratio
        rate = ratio.output_rate(samples['velocity'] * (1.0 + samples['slope']))
        unknown = np.where(history > 0.0, np.inf, 0.0)
        effort = float(ratio) * samples['effort']
        return (
            (position - history, position + history),
            (rate - unknown, rate + unknown),
            (effort, effort),
        )


class CorrectedInterval(JointStateTopic):
    """corrected_interval; samples have the fields of `Correction`, too."""

    units: ClassVar[Mapping[str, str]] = {'half width': 'rad'}

    def _expected(self, samples: Window) -> Sequence[Bounds]:
        half_width = samples['half_width']
        return ((half_width - samples['unknown_history'], half_width),)


CORRECTED: Mapping[str, type[JointStateTopic]] = {
    CORRECTED_STATE: CorrectedState,
    CORRECTED_INTERVAL: CorrectedInterval,
}
"""Class that compares each of CORRECTED_TOPICS."""


def why_unjudged(calibration: Calibration | None, parameters: NodeParameters) -> str:
    """Return why the corrected output cannot be judged; an empty text if it can."""
    if not calibration:
        return 'no calibration is given'
    if parameters.absolute:
        return 'a recording does not show when the output encoder referenced the rotor'
    if parameters.rotor_period and calibration.period > 1:
        return 'a recording does not show when a single-turn encoder was referenced'
    return ''
