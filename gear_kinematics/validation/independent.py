# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges recorded outputs by code that the node does not run.

The node and the usual validation decode messages, count turns and solve the motion by the same
code, whose errors would be on both sides of the comparison. Here `struct` decodes, a single-turn
encoder turns to the nearest angle, and the matrix method solves the motion, in float64: 1e-9 rad
are kept up to 10⁷ rad of the rotor. Inputs without an output are not judged.
"""

import math
import struct
from collections import defaultdict
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from gear_kinematics.bag import MessagesByTopic
from gear_kinematics.bag.roles import Topics
from gear_kinematics.kinematics import Mechanism, matrix_method
from gear_kinematics.validation.independent_bodies import (
    errors_of_joints,
    errors_of_poses,
    own_joints,
)
from gear_kinematics.validation.independent_message import (
    IndependentMessage,
    InputTime,
    Known,
    State,
    Waiting,
    paired,
)
from gear_kinematics.validation.task import Task

_KEPT = 20_000  # inputs, outputs, poses and joints that wait for each other
_LARGEST = math.tau * 2**51  # rad; no output answers a greater position
_UNITS = {'position': 'rad', 'velocity': 'rad/s', 'effort': 'N·m'}
_UNITS |= {'position of bodies': 'm', 'orientation of bodies': 'rad'}
_UNITS |= {'position of joints': 'rad', 'slide of joints': 'm'}
_UNITS |= {'velocity of joints': 'rad/s', 'slide velocity of joints': 'm/s'}


@dataclass(frozen=True, slots=True)
class IndependentReport:
    """The result of the independent comparison."""

    compared: int  # messages of the output, the poses and the joints whose input is there
    not_compared: int
    turns_taken: int  # how often the turns, or another zero, were taken from the outputs
    errors: dict[str, float]  # greatest errors by field, in rad, rad/s, N·m, m, m/s
    first_wrong: int | None
    passed: bool

    @property
    def text(self) -> str:
        """The result in one sentence."""
        if not self.compared:
            return 'independently, nothing could be compared: no output has the stamp of an input'
        worst = ', '.join(f'{name} {e:.2g} {_UNITS[name]}' for name, e in self.errors.items())
        verdict = 'agree with' if self.passed else 'differ from'
        return f'{self.compared} outputs {verdict} the matrix method; largest errors: {worst}'


class Independent:
    """Compares outputs with what their inputs mean, in one pass over a recording."""

    def __init__(self, task: Task, topics: Topics, joint_states: str = '') -> None:
        """Prepare for a recording; where the task is strict, outputs of another zero are wrong.

        An absolute encoder at the output can change the count once, and after gaps again: that of
        an encoder that repeats by whole periods, and another one to any zero.

        `joint_states` is the topic of the joints of the mechanism, if recorded.
        """
        self._parameters = parameters = task.parameters
        self._topics, self._joint_states = topics, joint_states
        self._any_zero = not task.strict or (parameters.absolute and not parameters.rotor_period)
        self._referable = parameters.absolute  # whether that encoder may yet give the count
        self._ratio, self._direction = parameters.gear.gear_ratio, parameters.rotor_direction
        self._joint = parameters.output_name if parameters.actuator else ''  # the only one
        units = _UNITS | {'slide velocity of joints': 'rad/s'}  # with the tolerance of velocities
        self._limits = {name: task.tolerances.of(unit) for name, unit in units.items()}
        self._errors: dict[str, float] = {}
        self._wrong: list[int] = []
        self._inputs: Known = defaultdict(list)  # states
        self._outputs = list[Waiting]()  # states
        self._bodies = {topic: list[Waiting]() for topic in (topics.poses, joint_states)}
        self._motions: dict[str, Known] = {topic: defaultdict(list) for topic in self._bodies}
        """Angles and velocities of the rotor, rad and rad/s, that bodies lack."""
        self._time = InputTime()
        self._last: tuple[int, float] | None = None  # time and position of the last output
        self._offset: float | None = None  # rad, from positions to rotor angles
        self._given = self._compared = self._taken = 0

    def take(self, messages: MessagesByTopic) -> None:
        """Take the next messages of each topic, in the order of their reception."""
        topics = dict.fromkeys((*self._topics, self._joint_states))
        every = [(of, zip(messages[of].data, messages[of].received, strict=True)) for of in topics]
        for topic, data, received in ((of, *each) for of, given in every for each in given):
            self._given += topic != self._topics.rotor
            with suppress(ValueError, IndexError, struct.error):  # it cannot be decoded
                message = IndependentMessage(data)
                at = message.stamp, received
                if topic == self._topics.rotor:
                    state = message.joint(self._parameters.rotor_joint)
                    # NaN is not; outputs of inputs without a stamp have the time of the node.
                    if message.stamp and abs(state[1]) <= _LARGEST:
                        time = self._time.at(message.stamp)
                        self._inputs[message.stamp].append((received, (time, *state[1:])))
                elif topic == self._topics.output:
                    self._outputs.append((*at, message.joint(self._joint)))
                elif topic == self._topics.poses:
                    self._bodies[topic].append((*at, message.array(7)))
                else:
                    joints = own_joints(self._parameters, *message.joints())
                    self._bodies[topic].append((*at, joints))
        self._compare()
        self._outputs = self._outputs[-_KEPT:]
        self._bodies = {topic: kept[-_KEPT:] for topic, kept in self._bodies.items()}
        known: list[dict[int, Any]] = [self._inputs, *self._motions.values()]
        for kept in known:
            for stamp in list(kept)[:-_KEPT]:
                del kept[stamp]

    def report(self) -> IndependentReport:
        """Return the result on all messages."""
        first, count = min(self._wrong, default=None), self._compared
        counts = count, self._given - count, self._taken
        return IndependentReport(*counts, self._errors, first, count > 0 and first is None)

    def _compare(self) -> None:
        """Compare the outputs, poses and joints whose inputs have arrived."""
        pairs = paired(self._outputs, self._inputs)
        angles = [self._angle(given, output) for *_, output, given in pairs]
        stamps = [stamp for stamp, *_ in pairs]
        both = np.reshape([(output[1:], given[1:]) for *_, output, given in pairs], (-1, 2, 3))
        recorded, given = both[:, 0], both[:, 1]
        rate = self._direction * given[:, 1]
        for motions in self._motions.values():
            for (stamp, at, *_), *motion in zip(pairs, angles, rate.tolist(), strict=True):
                motions[stamp].append((at, motion))
        expected = [np.array(angles) / float(self._ratio), rate / float(self._ratio)]
        gear = self._parameters.gear
        if isinstance(gear, Mechanism):
            state = matrix_method.solve(gear, angles, rate)
            expected = [state.output_angle, state.output_velocity]
        torque = self._direction * self._parameters.rotor_effort_factor * given[:, 2]
        expected.append(float(self._ratio) * torque)
        for k, name in enumerate(('position', 'velocity', 'effort')):
            withheld = np.isnan(recorded[:, k]) & (k > 0)
            self._note(name, stamps, np.where(withheld, 0.0, np.abs(recorded[:, k] - expected[k])))
        for topic, waiting in self._bodies.items():
            found = paired(waiting, self._motions[topic])
            if isinstance(gear, Mechanism) and found:
                of, _, given_bodies, moved = zip(*found, strict=True)
                errors_of = errors_of_poses if topic == self._topics.poses else errors_of_joints
                for name, errors in errors_of(gear, np.transpose(moved), given_bodies).items():
                    self._note(name, of, errors)

    def _angle(self, given: State, output: State) -> float:
        """Return the rotor angle of an input, whose turns or zero may come from the output."""
        parameters, time, position = self._parameters, given[0], given[1]
        period, absolute = parameters.rotor_period, parameters.absolute
        first, lost, before = self._offset is None, False, self._offset or 0.0
        if self._last:
            elapsed, turned = (time - self._last[0]) * 1e-9, position - self._last[1]
            if period:
                position = self._last[1] + math.remainder(turned, period)
                lost = elapsed * parameters.max_rotor_speed >= 0.5 * period
            if lost or (not period and elapsed > parameters.longest_silence):
                self._referable = absolute
        self._last = time, position
        angle = self._direction * (position - parameters.rotor_zero)
        missing = output[1] * float(self._ratio) - angle - before
        known = self._limits['position'] * abs(float(self._ratio))
        referred = not (first or lost) and abs(missing) > known
        if first or lost or (referred and self._referable):
            self._referable &= not referred
            whole = period * round(missing / period) if period else 0.0
            exact = abs(missing - whole) <= known or not self._any_zero or (period and not first)
            self._offset = before + (whole if exact else missing)
            self._taken += self._offset != before
        return angle + (self._offset or 0.0)

    def _note(self, name: str, stamps: Sequence[int], errors: Any) -> None:
        errors = np.where(np.isnan(errors), math.inf, errors)
        self._errors[name] = float(errors.max(initial=self._errors.get(name, 0.0)))
        self._wrong += np.array(stamps)[errors > self._limits[name]].tolist()[:1]
        self._compared += len(stamps) * (name.startswith('position'))
