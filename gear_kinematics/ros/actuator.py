# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""An actuator of the node: its state, where its shaft is, and how fast its rotor turns."""

import math
import time

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.belief import VelocityMeaning
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.loads import PreloadMonitor
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND

_SPEED_SPAN = 100_000_000
"""Least time between the positions that give a speed, ns. Of messages at 1 kHz, one step of an
encoder with 4096 counts per turn would be 1.5 rad/s, and 0.08 rad/s at an output at rest."""


class RefusedError(RuntimeError):
    """A shaft cannot be homed, because of a fault, for which there is a remedy."""

    def __init__(self, fault: str, remedy: str) -> None:
        super().__init__(fault + remedy)
        self.fault, self.remedy = fault, remedy


class Actuator:
    """The state of an actuator, and the motion of its shaft."""

    _before: RotorSample  # where `_speed` was measured last

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        self.state = GearState(parameters, calibration)
        if parameters.preload:
            self.state.preload_monitor = PreloadMonitor(parameters)
        self.referenced: bool | None = None  # whether turns are known, as last published
        self.last: RotorSample | None = None  # the latest sample
        self._seen = 0.0  # time of the last valid input; s of a steady clock
        self._speed = 0.0  # of the rotor, rad/s, by its positions
        self._due = 0  # the stamp of the next measurement, ns
        self._gaps, self._origin = 0, -1
        """Number of gaps that could hide a turn, and of all else that begins a new segment."""

    def note(self, now: float) -> None:
        """Note a valid message of the rotor, and its mean speed over `_SPEED_SPAN`, 0 at first.

        Where a new count begins, the last known speed remains until the next can be measured.
        """
        state = self.state
        state.monitor.last_input = self._seen = now
        self.last = sample = state.sample
        if 0 < self._due - sample[0] <= _SPEED_SPAN:  # its stamp, by the fastest way
            return
        turns = state.input.turns
        origin, gaps = state.segment - turns.unknown_gaps, turns.unknown_gaps
        if origin == self._origin and sample.stamp > self._before.stamp:
            moved = sample.position.since(self._before.position)
            if gaps != self._gaps:  # whole turns may be missing
                moved = math.remainder(moved, turns.period or math.inf)
            self._speed = moved / (sample.stamp - self._before.stamp) * SECOND
        self._before, self._origin, self._gaps = sample, origin, gaps
        self._due = sample.stamp + _SPEED_SPAN

    @property
    def _present_speed(self) -> float:
        """Speed of the rotor, rad/s, by velocities only where they were found right in motion."""
        state, sample, before = self.state, self.state.sample, self._before
        given, finding = sample.velocity, state.input.velocity_field.finding
        if given is not None and finding is VelocityMeaning.RIGHT:
            return abs(given)
        same = state.segment == self._origin + self._gaps
        moved = sample.position.since(before.position) if same else 0.0
        span = max(sample.stamp - before.stamp, _SPEED_SPAN) / SECOND
        return max(abs(given or 0.0), abs(self._speed), abs(moved) / span)

    @property
    def rotor_angle(self) -> float:
        """The angle of the rotor at `home_angle`, rad."""
        parameters = self.state.parameters
        return float(parameters.gear.gear_ratio.rotor_angle(parameters.home_angle))

    def home_zero(self) -> tuple[float, str]:
        """Return `rotor_zero`, rad, for a shaft at `home_angle`, and say where it was and is.

        Raises RefusedError if the shaft cannot be homed; the text says why.
        """
        parameters, rotor = self.state.parameters, self.state.input
        ratio, limit = parameters.gear.gear_ratio, parameters.home_max_speed
        try:
            zero = rotor.zero_for(self.rotor_angle)
            before = rotor.turns.relative_to(rotor.zero, parameters.rotor_direction)
        except RuntimeError as error:  # after the joint was changed, too
            none = f'no valid {topics.ROTOR_STATE} has come yet'
            raise RefusedError(none, '; check the driver') from error
        # By their numbers: without them, a second publisher on a shared topic may just be idle.
        if self.state.monitor.publishers.several:  # whichever was right, the zero may not be
            raise RefusedError('several drivers send its joint', '; stop all but one')
        speed = abs(ratio.output_rate(self._present_speed))
        age, span = time.monotonic() - self._seen, _SPEED_SPAN / SECOND
        rejected = (self.state.monitor.last_input or 0.0) - self._seen > span
        unseen = age > parameters.input_timeout or rejected
        if speed > limit and not unseen:
            too_fast = f', faster than home_max_speed, {limit:g} rad/s; stop it and home it again'
            raise RefusedError(f'the shaft turns at {speed:.3g} rad/s', too_fast)
        if unseen or speed * age > limit * span:
            last = f'the last valid {topics.ROTOR_STATE} came {age:.1f} s ago'
            raise RefusedError(last, '; check the driver')
        whole, rest = ratio.output_angle(*before, math)
        was, now = math.degrees(TURN * whole + rest), math.degrees(parameters.home_angle)
        return zero, f'the shaft was at {was:z.1f}° and is now at {now:z.1f}°'
