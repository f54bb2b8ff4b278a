# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The calibrated deviation of the real from the ideal output angle, with its 95 % interval."""

import math
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.wire.batches import Array
from gear_kinematics.wire.cdr import SECOND

MAX_GAP = SECOND  # ns between samples after which the hysteresis is unknown: motion was missed
_SAMPLING = SECOND // 10
"""Gap between samples, ns, beyond which the motion is not followed, whatever their usual period.

A gap of more than three periods is not followed either, since messages were lost."""
_CHUNK = 4096  # samples that are converted to lists at a time, since lists take much memory


class Correction(NamedTuple):
    """Correction of the ideal output angle, as floats or arrays (n,)."""

    deviation: Any  # deviation of the real from the ideal output angle, rad
    slope: Any  # derivative of the deviation with respect to the ideal output angle
    half_width: Any  # of the 95 % interval of the real about the corrected output angle, rad
    unknown_history: Any  # part of `half_width` by which another history could change it, rad


class Corrector:
    """Computes the correction sample by sample, or for many at once with the same result.

    Along the ideal output angle x = φ2/i, the state d of a stop operator of radius r follows
    d ← clip(d + Δx, -r, r) (Prandtl and Ishlinskii). An unknown state is the interval of all
    possible ones; both its ends follow the same rule, and meet after a travel of 2 r in one
    direction. In a gap, the states move as far as a reversal could have driven them.

    The half width is that of the file, or its `outside_half_width` where speed, torque or output
    angle are outside the calibrated spans; an unknown speed counts as inside. It grows by what
    unknown parts of the deviation can contribute: stop operators before a long enough travel,
    orders of the output while the rotor's turns are unknown, and wind-up without an effort.
    """

    def __init__(self, calibration: Calibration, max_acceleration: float = math.inf) -> None:
        """Begin with unknown states; `max_acceleration` of the rotor, rad/s², bounds reversals."""
        self.max_acceleration = max_acceleration
        self._calibration = calibration
        self._ratio = float(calibration.gear_ratio)
        self._per_rotor = float(1 / calibration.gear_ratio)
        self._period = calibration.period
        self._period_angle = self._period * TURN * abs(self._per_rotor)
        # p of q cycles in a turn, over whole turns p mod q; cycles in a turn of the output.
        self._orders = [
            (p % q, q, p / q, self._ratio * (p / q), order.cos, order.sin)
            for order in calibration.orders
            for p, q in [order.cycles.as_integer_ratio()]
        ]
        self._within_turn = [order for order in self._orders if order[1] == 1]
        self._beyond_turn = sum(math.hypot(*order[4:]) for order in self._orders if order[1] > 1)
        self._segment, self._referenced = 0, True
        self._stamps = 4 * (-SECOND,)  # of the last samples
        self._last = 0.0, 0.0
        self.reset()

    def reset(self) -> None:
        """Forget the motion so far, as after homing: the states are unknown."""
        # Radius and coefficient of each operator, and its least and greatest possible state.
        self._stops = [
            (stop.radius, stop.coefficient, [-math.inf, math.inf])
            for stop in self._calibration.hysteresis
        ]

    def correct(
        self, sample: RotorSample, *, segment: int = 0, referenced: bool = True
    ) -> Correction:
        """Compute the correction at the next sample.

        Args:
            sample: sample of the rotor.
            segment: as in `RotorSamples`; the states are unknown after it has changed.
            referenced: whether the rotor's turns are known; the states are unknown after homing.
        """
        stamp, (turns, angle), velocity, effort = sample
        hysteresis = self._follow(referenced, stamp, turns, angle, segment)
        velocity = math.nan if velocity is None else velocity
        torque = math.nan if effort is None else self._ratio * effort
        return self._correction(math, turns, angle, velocity, torque, hysteresis, referenced)

    def correct_batch(
        self,
        stamp: Array,
        turns: Array,
        angle: Array,
        velocity: Array,
        effort: Array,
        segment: Array,
        *,
        referenced: Array | bool = True,
    ) -> Correction:
        """Compute the correction at the next samples.

        Their columns, (n,), are as in `RotorSamples`, with NaN for an unknown velocity or effort;
        `referenced` is of all samples, or of each.
        """
        columns: list[Any] = [stamp, turns, angle, velocity, effort, segment]
        known = np.broadcast_to(referenced, stamp.shape)
        if len(changes := np.flatnonzero(np.diff(known)) + 1):
            parts = zip(*(np.split(column, changes) for column in (*columns, known)), strict=True)
            found = [self.correct_batch(*part, referenced=alike) for *part, alike in parts]
            return Correction(*map(np.concatenate, zip(*found, strict=True)))
        columns, referenced = [stamp, turns, angle, segment], bool(known.all())
        hysteresis = np.empty((3, len(stamp)))
        for start in range(0, len(stamp), _CHUNK):
            chunk = slice(start, start + _CHUNK)
            rows = zip(*(column[chunk].tolist() for column in columns), strict=True)
            hysteresis[:, chunk] = np.array([self._follow(referenced, *row) for row in rows]).T
        torque = self._ratio * effort
        return self._correction(np, turns, angle, velocity, torque, hysteresis, referenced)

    def _follow(
        self,
        referenced: bool,  # noqa: FBT001, without names it is called faster
        stamp: int,
        turns: float,
        angle: float,
        segment: int,
    ) -> tuple[float, float, float]:
        """Follow the stop operators to the next sample.

        Returns:
            Their contribution to the deviation, rad, as the middle of its range over all
            possible histories; its slope; and half of that range, rad.
        """
        first, second, third, last = self._stamps
        gap, (turns_before, angle_before) = stamp - last, self._last
        step = ((turns - turns_before) * TURN + angle - angle_before) * self._per_rotor
        if referenced != self._referenced or segment != self._segment or not 0 <= gap <= MAX_GAP:
            self.reset()
            self._segment, self._referenced = segment, referenced
        elif gap > _SAMPLING or gap > last - first:
            self._widen(gap, step)
        self._stamps, self._last = (second, third, last, stamp), (turns, angle)
        deviation = slope = unknown = 0.0
        for radius, coefficient, states in self._stops:
            if len(states) == 1:  # its history is known, as it nearly always is
                state = states[0] + step
                if state < -radius:
                    state = -radius
                elif state > radius:
                    state = radius
                else:
                    slope += coefficient
                states[0] = state
                deviation += coefficient * state
                continue
            part = 0.5 * coefficient
            for k, before in enumerate(states):
                state = before + step
                if state < -radius:
                    state = -radius
                elif state > radius:
                    state = radius
                else:
                    slope += part
                states[k] = state
                deviation += part * state
            if states[0] == states[1]:
                del states[1:]
            else:
                unknown += abs(part) * (states[1] - states[0])
        return deviation, slope, unknown

    def _widen(self, gap: int, step: float) -> None:
        """Widen the states by the unseen motion of the output in a gap, ns, before a step, rad.

        Its acceleration makes it deviate from a uniform motion between the samples by at most
        a t²/8.
        """
        beyond = abs(self.max_acceleration * self._per_rotor) * (gap / SECOND) ** 2 / 8.0
        back, ahead = min(step, 0.0) - beyond, max(step, 0.0) + beyond
        for radius, _, states in self._stops:
            states[:] = min(states[0], radius - ahead), max(states[-1], -radius - back)

    def _correction(
        self,
        xp: ModuleType,
        turns: Any,
        angle: Any,
        velocity: Any,
        torque: Any,
        hysteresis: Any,
        referenced: bool,  # noqa: FBT001, without names it is called faster
    ) -> Correction:
        """Evaluate the formula; `xp` is `math` for floats, or numpy for arrays, (n,).

        Velocity of the rotor and torque at the output are NaN where they are unknown; `hysteresis`
        is what `_follow` returns.
        """
        file, where = self._calibration, _choose if xp is math else np.where
        spans, wind_up = file.spans, file.compliance
        lag, lag_slope, history = hysteresis
        deviation, slope, unknown = file.constant, 0.0, 0.0 if referenced else self._beyond_turn

        turn = turns % self._period
        for part, denominator, cycles, rate, cos, sin in (
            self._orders if referenced else self._within_turn
        ):
            phase = TURN * (part * turn % denominator / denominator) + cycles * angle
            cosine, sine = xp.cos(phase), xp.sin(phase)
            deviation += cos * cosine + sin * sine
            slope += rate * (sin * cosine - cos * sine)
        deviation, slope, unknown = deviation + lag, slope + lag_slope, unknown + history

        no_torque, speed = xp.isnan(torque), velocity * self._per_rotor
        if wind_up is not None and spans.torque is not None:
            half = 0.5 * abs(wind_up.coefficient) * (spans.torque[1] - spans.torque[0])
            twist = wind_up.coefficient * (torque - wind_up.torque)
            deviation = deviation + where(no_torque, 0.0, twist)
            unknown = unknown + where(no_torque, half, 0.0)

        inside = spans.speed is None or xp.isnan(speed) | _contains(spans.speed, speed)
        if spans.torque is not None:
            inside = inside & (no_torque | _contains(spans.torque, torque))
        if referenced and self._period > 1:
            # Distance of the output from the start of its calibrated span, within a period.
            beyond = (TURN * turn + angle) * self._per_rotor - spans.angle[0]
            inside = inside & (beyond % self._period_angle <= spans.angle[1] - spans.angle[0])
        half_width = where(inside, file.half_width, file.outside_half_width) + unknown
        return Correction(deviation, slope, half_width, history)


def _choose(condition: bool, yes: float, no: float) -> float:  # noqa: FBT001, as np.where
    return yes if condition else no


def _contains(span: tuple[float, float], value: Any) -> Any:
    return (span[0] <= value) & (value <= span[1])
