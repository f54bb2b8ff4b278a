# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reads the rotor's position from serialised rotor_state messages, and rejects bad ones."""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

import numpy as np

from gear_kinematics.kinematics import RotorPosition, RotorSample, RotorTurns, split_turns
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.parameters import PARAMETERS, NodeParameters
from gear_kinematics.state.belief import BELIEVED, Belief
from gear_kinematics.state.disorder import Disorder, Late, order
from gear_kinematics.state.effort_field import EffortField
from gear_kinematics.state.joint_counts import JointCounts
from gear_kinematics.state.plausibility import Plausibility
from gear_kinematics.state.rotor_samples import RotorSamples, Row
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.velocity_field import VelocityField
from gear_kinematics.state.wraps import why_unknown
from gear_kinematics.wire.batches import Array, decode_joint_states
from gear_kinematics.wire.cdr import LATEST, SECOND
from gear_kinematics.wire.joint_reader import (
    CLOCK_RESET,
    GREATEST,
    JointMessage,
    JointReader,
    RejectedInputError,
    Rejection,
)

_new = tuple.__new__  # faster than RotorSample(...)
_ENCODERS = {name for name in PARAMETERS if name.startswith(('rotor_', 'output_encoder_'))}
_ENCODERS -= {'rotor_effort_factor'}
"""Parameters on which the turns depend that an absolute encoder at the output has found."""


class RotorInput(JointCounts):
    """Processes rotor_state messages and counts what is wrong with them."""

    def __init__(self, parameters: NodeParameters) -> None:
        super().__init__()
        self.duplicates = self.zero_stamps = self.resets = 0
        self.unnormalised_stamps = 0  # stamps with a second or more of nanoseconds, normalised
        self.last: RotorSample | None = None
        self.zero = split_turns(parameters.rotor_zero)  # zero in use; a reference can replace it
        self.origin: Fact | None = None  # source of the turn count: homing or the output's encoder
        self._restarts = 0  # by homing, references and changed parameters of encoders
        self.rezeroed = 0  # number of these that gave the same motion another zero
        (speed, acceleration), period = parameters.rotor_limits, parameters.rotor_period
        self.plausibility = Plausibility(speed, acceleration, period)
        self.disorder = Disorder(self.plausibility.alternation)
        self.turns = RotorTurns(period=period, max_speed=speed, max_acceleration=acceleration)
        self._configure(parameters)
        self._start()

    def _configure(self, parameters: NodeParameters) -> None:
        self._parameters = parameters
        self.turns.max_speed, self.turns.max_acceleration = parameters.rotor_limits
        self.turns.longest_silence = parameters.longest_silence * SECOND
        self._torque_factor = parameters.rotor_direction * parameters.rotor_effort_factor
        """N·m of the rotor, in its direction, per unit of the effort in the messages."""

    def _start(self) -> None:
        """Start with the joint and the encoder of the parameters, of which nothing is known."""
        self.turns.reset()
        self._reader = JointReader(self._parameters.rotor_joint)
        self.velocity_field = VelocityField(float(1 / self._parameters.gear.gear_ratio))
        self.effort_field = EffortField()

    @property
    def parameters(self) -> NodeParameters:
        """Parameters of the node, which can change any time; another encoder resets the state."""
        return self._parameters

    @parameters.setter
    def parameters(self, parameters: NodeParameters) -> None:
        before, joint = self._parameters, parameters.rotor_joint
        self._configure(parameters)
        limits, period = parameters.rotor_limits, parameters.rotor_period
        if (limits, period) != (before.rotor_limits, before.rotor_period):
            self.plausibility.restrict(*limits, period)
        if any(getattr(parameters, name) != getattr(before, name) for name in _ENCODERS):
            self.zero = split_turns(parameters.rotor_zero)
            self._restarts += 1
            self.rezeroed += parameters.only_zero_differs(before)
            if parameters.absolute or before.absolute:
                self.turns.forget_turns()
        if (joint, period) != (before.rotor_joint, before.rotor_period):
            self.turns.period = period
            self.plausibility.reset()
            self._start()
            self.missing_joint, self.last = '', None

    @property
    def referenced(self) -> bool:
        """Whether the rotor's turn count is known."""
        return self.turns.referenced

    @property
    def why_lost(self) -> Fact | None:
        """How the turns were lost, as far as that is known."""
        return self.plausibility.jumped or why_unknown(self.turns)

    @property
    def mostly_rejected(self) -> bool:
        """Whether more messages were rejected than accepted."""
        return 2 * self.rejected.total() > self.received - self.of_others

    @property
    def why_rejected(self) -> str:
        """The causes with their counts, and the joints there are if the wanted one is missing."""
        causes = ', '.join(f'{cause} {count}' for cause, count in self.rejected.items())
        hint = f'{self.missing_joint}; give the right --config or --joint'
        return f'{causes}: {hint}' if self.missing_joint else causes

    @property
    def segment(self) -> int:
        """Number that rises where the turn count restarts, is uncertain or is referenced."""
        return self.turns.unknown_gaps + self.resets + self._restarts + self.plausibility.jumps

    def accept(self, data: JointMessage, now: Callable[[], int]) -> RotorSample:
        """Process the next message; one without a stamp gets the time of the clock `now`, ns.

        Raises RejectedInputError, which is counted, if the message gives no output.
        """
        self.received += 1
        try:
            values = data if type(data) is tuple else self._reader.read(data)
            stamp, unnormalised, position, velocity, effort = values
            self.unnormalised_stamps += unnormalised
            return self._take(stamp or self._clock(now), position, velocity, effort)
        except RejectedInputError as rejection:
            self.reject(rejection, found=self.last is not None)
            raise

    def home(self, rotor_angle: float) -> float:
        """Declare that the rotor is at an angle now, and return the zero, both in rad.

        Raises RuntimeError before the first valid message.
        """
        zero = self.turns.home(rotor_angle, self._parameters.rotor_direction)
        self.zero, self.origin = split_turns(zero), Condition.HOMED()
        self.plausibility.repeats.lasts = 0.0  # until the next step shows it, of a mended driver
        self.plausibility.jumped_by = 0.0
        self._restarts += 1
        self.rezeroed += 1
        return zero

    def refer(self, origin: Fact, turns: int = 0, angle: float = 0.0) -> None:
        """Add 2π `turns` + `angle`, rad, to the rotor angle from the next message on.

        From then on the turns are known, by their origin, and a new segment begins. `parameters`
        stay as they are.
        """
        direction, (zero_turns, zero_angle) = self._parameters.rotor_direction, self.zero
        self.zero = RotorPosition(zero_turns - direction * turns, zero_angle - direction * angle)
        self.origin = origin
        self.turns.refer()
        self.plausibility.jumped_by = 0.0
        self._restarts += 1

    def zero_for(self, rotor_angle: float) -> float:
        """Find the zero that `home` would set, or raise its error, without changing anything."""
        return self.turns.zero_for(rotor_angle, self._parameters.rotor_direction)

    def accept_batch(self, messages: Sequence[bytes], received: Sequence[int]) -> RotorSamples:
        """Process many messages with the result of `accept`; reception, ns, is their clock."""
        before = self.received
        states = decode_joint_states(messages, self._parameters.rotor_joint)
        position = np.abs(states.values[:, 0])  # NaN if it is missing, or the message malformed
        usable = states.arrays_fit & (position <= LARGEST_ANGLE) & (states.stamp <= LATEST)
        stamps, values, clock = states.stamp, states.values, np.asarray(received, np.int64)
        rows, rejected = np.arange(len(messages)), stamps[:0]
        if not usable.all():
            left = np.ones(len(messages), bool)
            # In the order of the checks in `accept`.
            for faulty, cause in (
                (states.malformed, Rejection.MALFORMED),
                (states.stamp > LATEST, Rejection.STAMP_OUT_OF_RANGE),
                (~states.joint_found, Rejection.JOINT_MISSING),
                (~states.arrays_fit, Rejection.ARRAY_SIZES),
                (~states.present[:, 0], Rejection.POSITION_MISSING),
                (~np.isfinite(position), Rejection.POSITION_NOT_FINITE),
                (position > LARGEST_ANGLE, Rejection.POSITION_TOO_LARGE),
            ):
                if count := int(np.count_nonzero(faulty & left)):
                    self.rejected[cause] += count
                left &= ~faulty
            rows, rejected = np.flatnonzero(usable), stamps[states.joint_found & ~usable]
            stamps, values, clock = stamps[rows], values[rows], clock[rows]
        self.missing_joint = self.missing_joint or states.missing_joint
        if self.last or len(rows):
            self.leave_others()
        self.unnormalised_stamps += int(np.count_nonzero(states.unnormalised & usable))
        values[np.abs(values) > GREATEST] = np.nan
        parameters, last = self._parameters, self.last
        in_order, _ = order(stamps)
        in_order &= not (last and len(stamps) and stamps[0] < last.stamp)
        in_order &= not (parameters.rotor_period or parameters.absolute or self.disorder.readings)
        in_order = in_order and self.plausibility.believes(stamps, values[:, 0])
        take = self._all_at_once if in_order else self._one_by_one
        samples = take(rows, stamps, values, clock, rejected)
        self.received = before + len(messages)
        self.disorder.compare(samples, self.turns.max_acceleration)
        self.effort_field.note(samples.effort)
        return samples

    def _all_at_once(
        self, rows: Array, stamps: Array, values: Array, received: Array, rejected: Array
    ) -> RotorSamples:
        turns, angle = split_turns(values[:, 0])
        direction = self._parameters.rotor_direction
        velocity = self.velocity_field.believed(stamps, values[:-1], self.plausibility.noise)
        efforts = self.effort_field.all_believed(values[:, 0], values[:, 2])
        if len(stamps):
            _, repeats = order(stamps)
            self.duplicates += repeats + bool(self.last and stamps[0] == self.last.stamp)
            # The last one is processed singly, to update the state for the next messages.
            self.last = None
            last = self._take_row(int(stamps[-1]), values[-1].tolist()).velocity
            velocity = np.append(velocity, math.nan if last is None else direction * last)
        zero_turns, zero_angle = self.zero
        return RotorSamples(
            stamps,
            direction * (turns - zero_turns) + 0.0,  # turns that are int have no -0.0
            direction * (angle - zero_angle),
            direction * velocity,
            self._torque_factor * efforts,
            rows,
            received,
            np.full(len(stamps), self.segment),
            np.full(len(stamps), self.referenced),
            rejected,
        )

    def _one_by_one(
        self, rows: Array, stamps: Array, values: Array, received: Array, rejected: Array
    ) -> RotorSamples:
        taken, disordered = list[Row](), list[int]()
        before = self.received
        for row, stamp, numbers, now in zip(
            rows.tolist(), stamps.tolist(), values.tolist(), received.tolist(), strict=True
        ):
            self.received = before + row + 1
            try:
                sample = self._take_row(stamp or self._clock(partial(int, now)), numbers)
            except RejectedInputError as rejection:
                self.rejected[str(rejection)] += 1
                disordered.append(stamp)
                continue
            taken.append((sample, row, now, self.segment, self.referenced))
        return RotorSamples.of(taken, [*rejected.tolist(), *disordered])

    def _take_row(self, stamp: int, row: Sequence[float]) -> RotorSample:
        velocity, effort = (None if math.isnan(other) else other for other in row[1:])
        return self._take(stamp, row[0], velocity, effort)

    def _clock(self, now: Callable[[], int]) -> int:
        """Return the stamp for a message without one."""
        self.zero_stamps += 1
        if (stamp := now()) > LATEST:
            raise RejectedInputError(Rejection.STAMP_OUT_OF_RANGE)
        return stamp

    def _take(
        self, stamp: int, position: float, velocity: float | None, effort: float | None
    ) -> RotorSample:
        last = self.last
        if last is None:
            self.leave_others()
        elif stamp <= last[0]:  # its stamp, by the fastest way
            self._check_order(last.stamp, (stamp, position, velocity, effort))
        if self.disorder.readings and last:
            time, readings = self.disorder.set_back(last.stamp, stamp)
            self.turns.set_back(time)
            self.plausibility.set_back(time)
            for reading in readings:  # they have no outputs, but show turns and jumps
                self.last = None
                with suppress(RejectedInputError):
                    self._take(*reading)
        if (verdict := self.plausibility.judge(position, stamp)) is not BELIEVED:
            if verdict is Belief.IMPLAUSIBLE:
                raise RejectedInputError(Rejection.IMPLAUSIBLE)
            self.turns.lose()
            if self.plausibility.wraps.period:  # then no slope of the positions was a speed
                self.velocity_field = VelocityField(float(1 / self._parameters.gear.gear_ratio))
        if stamp < (field := self.velocity_field).quiet_until:
            gate = self.plausibility
            self.turns.update(position, stamp, velocity, gate.repeats.lasts, gate.likely)
            field.add(velocity)
        else:
            velocity = self._compare(stamp, position, velocity)
        if effort is not None and not self.effort_field.real:
            effort = self.effort_field.believed(self._unwrapped(position), effort)
        direction = self._parameters.rotor_direction
        self.last = sample = _new(RotorSample, (
            stamp,
            self.turns.relative_to(self.zero, direction),
            None if velocity is None else direction * velocity,
            None if effort is None else self._torque_factor * effort,
        ))  # fmt: skip
        return sample

    def _compare(self, stamp: int, position: float, velocity: float | None) -> float | None:
        """Update the turns; returns the velocity, unless the positions contradict it."""
        field, gate = self.velocity_field, self.plausibility
        given = None if field.contradicts else velocity
        self.turns.update(position, stamp, given, gate.repeats.lasts, gate.likely)
        if stamp < field.due:
            field.add(velocity)
            return None
        position = self._unwrapped(position)
        field.note(stamp, position, velocity, gate.noise)
        doubtful = field.contradicts and self.turns.narrowed > max(0, field.confirmed)
        if self.turns.period and (field.positions_stand or doubtful):
            self.turns.lose_unseen()
        return None if field.contradicts else velocity

    def _unwrapped(self, position: float) -> float:
        """Return the latest position, rad, without the wraps of an encoder that repeats."""
        if self.turns.period and (unwrapped := self.turns.position):
            return TURN * unwrapped.turns + unwrapped.angle
        return position

    def _check_order(self, last: int, reading: Late) -> None:
        stamp, position, *_ = reading
        if stamp == last:
            self.duplicates += 1
            # All came before, as of a relay that repeats messages, or there were turns between.
            if position == self.plausibility.position and not self.turns.period:
                self.disorder.readings.clear()
        elif last - stamp <= CLOCK_RESET:
            self.disorder.add(reading)
            raise RejectedInputError(Rejection.OUT_OF_ORDER)
        else:
            self.resets += 1
            self.disorder.note_reset(self.received, last, stamp)
            self.turns.reset()
            if self.plausibility.judge_reset(position, last, stamp) is Belief.JUMP:
                self.turns.lose()
            self.velocity_field.restart()
