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
from gear_kinematics.validation.independent_bodies import ERRORS_OF, own_joints
from gear_kinematics.validation.independent_message import IndependentMessage, State
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
            return 'independently, nothing could be compared'
        worst = ', '.join(f'{name} {e:.2g} {_UNITS[name]}' for name, e in self.errors.items())
        verdict = 'agree with' if self.passed else 'differ from'
        return f'{self.compared} outputs {verdict} the matrix method; largest errors: {worst}'


class Independent:
    """Compares outputs with what their inputs mean, in one pass over a recording."""

    def __init__(self, task: Task, topics: Topics, joint_states: str = '') -> None:
        """Prepare for a recording; where the task is strict, outputs of another zero are wrong.

        `joint_states` is the topic of the joints of the mechanism, if recorded.
        """
        self._parameters = parameters = task.parameters
        self._topics, self._joint_states, self._strict = topics, joint_states, task.strict
        self._ratio, self._direction = parameters.gear.gear_ratio, parameters.rotor_direction
        self._joint = parameters.output_name if parameters.actuator else ''  # the only one
        units = _UNITS | {'slide velocity of joints': 'rad/s'}  # with the tolerance of velocities
        self._limits = {name: task.tolerances.of(unit) for name, unit in units.items()}
        self._errors: dict[str, float] = {}
        self._wrong: list[int] = []
        self._inputs: dict[int, list[State]] = defaultdict(list)
        self._outputs = list[State]()
        self._bodies: dict[str, list[tuple[int, Any]]] = {topics.poses: [], joint_states: []}
        self._motions: dict[str, dict[int, list[tuple[float, float]]]] = {
            topic: defaultdict(list) for topic in self._bodies
        }
        """Angles and velocities of the rotor, rad and rad/s, that bodies lack, by their stamps."""
        self._last: tuple[int, float] | None = None  # stamp and position of the last output
        self._offset: float | None = None  # rad, from positions to rotor angles
        self._given = self._compared = self._taken = 0

    def take(self, messages: MessagesByTopic) -> None:
        """Take the next messages of each topic, in the order of their reception."""
        topics = dict.fromkeys((*self._topics, self._joint_states))
        for topic, data in ((of, data) for of in topics for data in messages[of].data):
            self._given += topic != self._topics.rotor
            with suppress(ValueError, IndexError, struct.error):  # it cannot be decoded
                message = IndependentMessage(data)
                if topic == self._topics.rotor:
                    state = message.joint(self._parameters.rotor_joint)
                    if abs(state[1]) <= _LARGEST:  # NaN is not
                        self._inputs[message.stamp].append(state)
                elif topic == self._topics.output:
                    self._outputs.append(message.joint(self._joint))
                elif topic == self._topics.poses:
                    self._bodies[topic].append((message.stamp, message.array(7)))
                else:
                    joints = own_joints(self._parameters, *message.joints())
                    self._bodies[topic].append((message.stamp, joints))
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
        pairs = _paired(self._outputs, self._inputs)
        angles = [self._angle(given, output) for output, given in pairs]
        stamps = [output[0] for output, _ in pairs]
        both = np.reshape([(output[1:], given[1:]) for output, given in pairs], (-1, 2, 3))
        recorded, given = both[:, 0], both[:, 1]
        rate = self._direction * given[:, 1]
        for motions in self._motions.values():
            for stamp, angle, velocity in zip(stamps, angles, rate.tolist(), strict=True):
                motions[stamp].append((angle, velocity))
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
            found = _paired(waiting, self._motions[topic])
            if isinstance(gear, Mechanism) and found:
                bodies, moved = zip(*found, strict=True)
                of, given_bodies = zip(*bodies, strict=True)
                errors_of = ERRORS_OF['poses' if topic == self._topics.poses else 'joints']
                for name, errors in errors_of(gear, np.transpose(moved), given_bodies).items():
                    self._note(name, of, errors)

    def _angle(self, given: State, output: State) -> float:
        """Return the rotor angle of an input, whose turns or zero may come from the output."""
        parameters, stamp, position = self._parameters, given[0], given[1]
        if (period := parameters.rotor_period) and self._last:
            elapsed, turned = stamp - self._last[0], position - self._last[1]
            position = self._last[1] + math.remainder(turned, period)
            if abs(elapsed) * 1e-9 * parameters.max_rotor_speed >= 0.5 * period:
                self._offset = None
        self._last = stamp, position
        angle = self._direction * (position - parameters.rotor_zero)
        if self._offset is None:
            missing = output[1] * float(self._ratio) - angle
            whole = period * round(missing / period) if period else 0.0
            known = self._limits['position'] * abs(float(self._ratio))
            self._offset = whole if self._strict or abs(missing - whole) <= known else missing
            self._taken += self._offset != 0.0
        return angle + self._offset

    def _note(self, name: str, stamps: Sequence[int], errors: Any) -> None:
        errors = np.where(np.isnan(errors), math.inf, errors)
        self._errors[name] = float(errors.max(initial=self._errors.get(name, 0.0)))
        self._wrong += np.array(stamps)[errors > self._limits[name]].tolist()[:1]
        self._compared += len(stamps) * (name.startswith('position'))


def _paired(waiting: list[Any], known: dict[int, list[Any]]) -> list[tuple[Any, Any]]:
    """Pair what begins with a stamp with what is known of it, in order; others go on waiting."""
    pairs, left = [], []
    for each in waiting:
        if rows := known.get(each[0]):
            pairs.append((each, rows.pop(0)))
        else:
            left.append(each)
    waiting[:] = left
    return pairs
