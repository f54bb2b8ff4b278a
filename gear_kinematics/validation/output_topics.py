# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the fields of each output topic with recomputed ones, sample by sample."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import ClassVar

import numpy as np

from gear_kinematics.kinematics import Mechanism, solve
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.diagnosis import AngleFit, FactorFit, diagnose
from gear_kinematics.validation.fields import Array, FieldSamples, Occurrences, Window
from gear_kinematics.validation.matching import Expectation, OutputTopic, rotor_angle
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.batches import (
    FIELDS,
    JointStateBatch,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)
from gear_kinematics.wire.cdr import joint_state_layout, pose_array_layout
from gear_kinematics.wire.joint_reader import joints_of
from gear_kinematics.wire.nearest import listed

Bounds = tuple[Array, Array]

_AHEAD = 1000  # samples that are compared with a message that has no stamp in common with any
_CHANGED = 10  # least number of outputs that are all wrong before or after one moment
_NEAR = 500_000_000  # ns between the reception of an input and the stamp of its output

STATE_UNITS = dict(zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True))
"""Units of the fields of a JointState by their names."""


class JointStateTopic(OutputTopic):
    """An output topic of JointStates with one joint; its fields are compared one by one."""

    units: ClassVar[Mapping[str, str]]  # units of the fields by their names
    layout = staticmethod(joint_state_layout)

    def __init__(self, name: str, joint: str, expectation: Expectation) -> None:
        super().__init__(name, joint, expectation, self.units)
        self.joints = (joint.encode(),)
        self._there = ''  # the joints of the first message without it

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._messages, self._states = messages, decode_joint_states(messages, self.label)
        return self._states.stamp, self._states.malformed

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        states = self._states
        without = ~states.joint_found[rows]
        if without.any():
            first = rows[without][0]
            self._there = self._there or listed(joints_of(self._messages[first]))
            self._faults[FindingCause.NO_JOINT, self._there].add(samples['stamp'][without])
        found = list[FieldSamples]()
        for k, (least, most) in enumerate(self._expected(samples)):
            recorded, expected = states.values[rows, k], least
            if least is not most:  # any value between them is as expected
                inside = np.clip(recorded, least, most)
                expected = np.where(np.isfinite(recorded), inside, least)
            error, one_sided = recorded - expected, np.zeros(0, np.intp)
            if not np.isfinite(error).all():
                wanted, there = ~np.isnan(expected), states.present[rows, k]
                if self.shared and k:  # a field that others have; a position cannot be absent
                    there = there & ~np.isnan(recorded)
                error = np.where(wanted & there, finite_or_infinite(error), np.nan)
                one_sided = np.flatnonzero(wanted != there)
            found.append(FieldSamples(error, one_sided, recorded, expected))
        return found

    def _expected(self, samples: Window) -> Sequence[Bounds]:
        """Return the least and the greatest value of each field; NaN where it is absent."""
        raise NotImplementedError

    def _ideal_angle(self, samples: Window) -> Array:
        """Return the ideal output angle at samples, (n,), rad."""
        output_turns, rest = self._gear.gear_ratio.output_angle(
            samples['turns'], samples['angle'], np
        )
        return np.asarray(TURN * output_turns + rest)


def finite_or_infinite(error: Array) -> Array:
    """Return errors with infinity in place of values that are not finite."""
    return np.where(np.isfinite(error), error, np.inf)


class OutputState(JointStateTopic):
    """output_state."""

    units: ClassVar[Mapping[str, str]] = STATE_UNITS

    def __init__(self, name: str, joint: str, expectation: Expectation) -> None:
        super().__init__(name, joint, expectation)
        self.fit = AngleFit()
        self._factors = {'velocity': FactorFit(), 'effort': FactorFit()}
        self._adopted = -1  # number of the latest sample that was given a stamp
        self._absent_velocities = Occurrences()
        self._only_zeros = True  # whether all given velocities were 0, and no output had one

    def why_none(self, parameters: NodeParameters, recorded: Collection[str]) -> str:
        """Say why no message is of this joint, by the topics that are recorded."""
        turns_open = parameters.rotor_period or parameters.absolute
        if turns_open and parameters.unreferenced_outputs == 'withhold':
            return 'no outputs in it: the node withholds them while the turns are not known'
        if self.name in recorded:
            return f'{self.name} has only other joints: give the parameters of its node'
        return 'no outputs in it: gearkin compute writes a bag with them'

    def _expected(self, samples: Window) -> Sequence[Bounds]:
        ratio = self._gear.gear_ratio
        angle = self._ideal_angle(samples)
        velocity, effort = ratio.output_rate(samples['velocity']), float(ratio) * samples['effort']
        return (angle, angle), (velocity, velocity), (effort, effort)

    def _adopt_stamps(self, stamps: Array, usable: Array, window: Window) -> None:
        rows = usable[~np.isin(stamps[usable], window['stamp'])]
        unstamped = (window['stamp'] == window['received']) & (window['number'] > self._adopted)
        waiting = np.flatnonzero(unstamped & ~self.matcher.matched)
        samples = window.take(waiting)
        self._changes.move(samples)
        angle, received = self._ideal_angle(samples), samples['received']

        def fit(message: int, ahead: slice) -> Array:
            error = np.abs(angle[ahead] - self._states.values[rows[message], 0])
            near = np.abs(received[ahead] - stamps[rows[message]]) < _NEAR
            return np.asarray(near & (error <= self._tolerances.angle))

        answers, found = _in_order(len(rows), len(samples), fit)
        window['stamp'] = window['stamp'].copy()  # other joints have them, too
        window['stamp'][waiting[found]] = stamps[rows[answers]]
        self._adopted = int(samples['number'][found].max(initial=self._adopted))

    def _adopt_fields(self, rows: Array, at: Array, window: Window) -> None:
        self._without_velocity = False
        if not (window['velocity_open'].any() or window['effort_open'].any()):
            return
        states, still_open = self._states, window['effort_open'][at]
        none = ~states.present[rows].T
        if self.shared:
            none |= np.isnan(states.values[rows].T)
        velocity = window['velocity'][at]
        given = window['velocity_open'][at] & ~np.isnan(velocity)
        self._without_velocity = without = given & none[1]
        self._only_zeros &= not np.any(given & ((velocity != 0.0) | ~none[1]))
        self._absent_velocities.add(window['stamp'][at[without]])
        window['velocity'][at[without]] = np.nan
        window['effort'][at[still_open & (states.values[rows, 2] == 0.0)]] = 0.0
        lacking = still_open & none[2]
        window['effort'][at[lacking]] = np.nan
        if 'acceleration' in window.columns:  # without either there are no loads
            window['acceleration'][at[lacking | without]] = np.nan

    def judge_velocities(self, *, contradict: bool) -> None:
        """Count outputs without a velocity from before the meaning of velocities was found.

        They are right if the velocities contradict the positions, as the node may have known. It
        may also have known, from a motion before, what a recording of zeros alone does not show.
        """
        if not (contradict or self._only_zeros):
            self.errors[1].absent.add_all(self._absent_velocities)
            self._wrong += self._wrong_without_velocity

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        position, *others = super()._compare(rows, samples)
        if self._changes.learn(samples, position):
            expected = self._ideal_angle(samples)
            error = finite_or_infinite(position.recorded - expected)
            error[np.isnan(position.error)] = np.nan
            position = position._replace(expected=expected, error=error)
        for factor, field in zip(self._factors.values(), others, strict=True):
            factor.update(field.recorded, field.expected)
        usable = np.isfinite(position.error)
        angles = rotor_angle(samples)[usable], position.recorded[usable]
        self.fit.update(*angles, position.error[usable])
        return position, *others

    def causes(self) -> Iterator[Finding]:
        """Yield what explains errors of the angle, or else of the velocity and the effort."""
        since, (before, first_right) = self._latest_wrong, self._until_right
        # Other errors, such as another ratio, also leave outputs right, but at one angle only.
        if self._wrong >= _CHANGED and len({*self._right}) > 1:
            if self._wrong == since.count:
                yield Finding(FindingCause.CHANGED, stamp=since.first, explains=True)
                return
            if self._wrong == before:
                yield Finding(FindingCause.CHANGED_TO_GIVEN, stamp=first_right, explains=True)
                return
        if not self.errors[0].report().passed:
            if found := diagnose(self._gear, self.fit, self._tolerances.angle):
                yield found
            return
        for field, fit in self._factors.items():
            if (factor := fit.factor()) is not None:
                values = {'field': field, 'factor': factor}
                yield Finding(FindingCause.ANOTHER_UNIT, values=values, explains=True)


class BodyPoses(OutputTopic):
    """body_poses."""

    layout = staticmethod(pose_array_layout)

    def __init__(
        self, name: str, frame_id: str, mechanism: Mechanism, expectation: Expectation
    ) -> None:
        super().__init__(name, frame_id, expectation, {'position': 'm', 'orientation': 'rad'})
        self._mechanism = mechanism
        self._axial = np.array([[b.axial_position] for b in mechanism.branches] * 2)

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._arrays: PoseArrays = decode_pose_arrays(messages, len(self._axial))
        return self._arrays.stamp, self._arrays.malformed

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        arrays, stamp = self._arrays, samples['stamp']
        for k, frame_id in enumerate(arrays.frame_ids):
            if frame_id != self.label.encode():
                fault = FindingCause.ANOTHER_FRAME, frame_id.decode(errors='replace')
                self._faults[fault].add(stamp[arrays.frame[rows] == k])
        poses = arrays.poses[rows]
        state = solve(self._mechanism, samples['angle'], rotor_turns=samples['turns'])
        centres = np.concatenate([state.satellite_centre, state.oldham_centre], axis=1)
        x, y, z, *quaternions = np.moveaxis(poses, (2, 1), (0, 1))  # bodies first: faster maxima
        x, y, z = x - centres[..., 0].T, y - centres[..., 1].T, z - self._axial
        position = np.hypot(np.hypot(x, y), z).max(axis=0)
        orientation = _orientation_error(quaternions, state.output_turn_angle)
        return [
            FieldSamples(np.where(samples['turns_known'], finite_or_infinite(error), np.nan))
            for error in (position, orientation)
        ]


class MechanismStates(OutputTopic):
    """mechanism_joint_states; the error of a message is the largest of its joints."""

    layout = staticmethod(joint_state_layout)

    def __init__(
        self, name: str, joints: Sequence[str], mechanism: Mechanism, expectation: Expectation
    ) -> None:
        units = {'angle': 'rad', 'slide': 'm', 'velocity': 'rad/s', 'slide velocity': 'm/s'}
        super().__init__(name, '', expectation, units)
        self.joints = [joint.encode() for joint in joints]
        self._mechanism = mechanism

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        batch = messages if isinstance(messages, JointStateBatch) else JointStateBatch(messages)
        stamp, malformed, count = batch.heads[0], np.ones(len(batch), bool), len(self.joints)
        self._values = np.full((2, len(batch), count), np.nan)
        self._moving = np.zeros(len(batch), bool)
        names = tuple(self.label.encode() + joint for joint in self.joints)
        own = batch.narrowed(self.joints) if self.shared else batch
        for rows, found, _, fields in own.contents():
            sizes = [field.shape[1] for field in fields]
            if found == names and sizes in ([count, 0, 0], [count, count, 0]):
                malformed[rows] = False
                for values, field in zip(self._values, fields[: 1 + bool(sizes[1])], strict=False):
                    values[rows] = field
                absent = np.isnan(self._values[1, rows]).all(axis=1)
                self._moving[rows] = ~absent if self.shared else sizes[1] > 0
        return stamp, malformed

    def _compare(self, rows: Array, samples: Window) -> Sequence[FieldSamples]:
        rotor, velocity = rotor_angle(samples), samples['velocity']
        state = solve(self._mechanism, samples['angle'], velocity, rotor_turns=samples['turns'])
        wanted, there = ~np.isnan(velocity), self._moving[rows]
        one_sided, branches = np.flatnonzero(wanted != there), len(self._mechanism.branches)
        slides = slice(1 + branches, 1 + 2 * branches)
        found = list[FieldSamples]()
        for recorded, known, given, output, sliding, unmatched in (
            (0, samples['turns_known'], rotor, state.output_angle, state.satellite_slide, []),
            (1, wanted & there, velocity, state.output_velocity,
             state.satellite_slide_velocity, one_sided),
        ):  # fmt: skip
            expected = [given, *[output - given] * branches, *sliding.T, output]
            error = finite_or_infinite(np.abs(self._values[recorded, rows].T - expected))
            error[:, ~known] = np.nan
            for each in (np.delete(error, slides, axis=0), error[slides]):
                found.append(FieldSamples(each.max(axis=0), np.asarray(unmatched, np.intp)))
        return found


def _orientation_error(quaternions: Sequence[Array], angle: Array) -> Array:
    """Return the greatest error of quaternions x, y, z and w, (bodies, n), from an angle about z.

    Angle and error are in rad, (n,).
    """
    x, y, z, w = quaternions
    sine, cosine = np.sin(0.5 * angle), np.cos(0.5 * angle)
    # A quaternion and its negative are the same rotation.
    sign = np.where(z * sine + w * cosine < 0.0, -1.0, 1.0)
    about_z = np.maximum(np.abs(z - sign * sine), np.abs(w - sign * cosine))
    tilt = np.maximum(np.abs(x), np.abs(y))
    error: Array = 2.0 * np.maximum(about_z, tilt).max(axis=0)
    return error


def _in_order(messages: int, samples: int, fit: Callable[[int, slice], Array]) -> Array:
    """Pair messages with samples in the order of both, and return the indices of both, (2, n).

    `fit` returns which samples fit a message. Messages that fit none are paired by their place
    between two that do; if there are none, all are paired by their place.
    """
    found = [(-1, -1)]
    for message in range(messages):
        after = found[-1][1] + 1
        fitting = fit(message, slice(after, after + _AHEAD))
        if fitting.any():
            found.append((message, after + int(np.argmax(fitting))))
    last, at = found[-1]
    ends = [*found[1:], (last + 1, at + 1) if len(found) > 1 else (messages, samples)]
    pairs = [
        (message + k, sample + k)
        for (message, sample), (end, sample_end) in zip(found, ends, strict=True)
        for k in range(min(end - message, sample_end - sample))
    ]
    return np.array(pairs[1:], np.intp).reshape(-1, 2).T
