"""Compares the fields of each output topic with recomputed ones, sample by sample."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.validation.diagnosis import (
    AngleFit,
    FactorFit,
    PoseOrder,
    describe_factor,
    diagnose,
)
from gear_kinematics.validation.fields import FieldErrors, FieldSamples
from gear_kinematics.validation.matching import Expectation, Faults, OutputTopic
from gear_kinematics.validation.report import Finding
from gear_kinematics.validation.unseen_turns import UnseenTurns
from gear_kinematics.wire.batches import (
    FIELDS,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)

Array = NDArray[Any]


class JointStateTopic(OutputTopic):
    """An output topic of JointStates with one joint; its fields are compared one by one."""

    units: ClassVar[Mapping[str, str]]
    """Units of the fields by their names."""

    def __init__(self, name: str, joint: str, expectation: Expectation) -> None:
        errors = (
            FieldErrors(field, unit, expectation.tolerances.of(unit))
            for field, unit in self.units.items()
        )
        super().__init__(name, expectation, *errors)
        self.joint = joint
        self.offset = 0.0
        """Known offset of the recorded angle, rad."""

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._states = decode_joint_states(messages, self.joint)
        return self._states.stamp, self._states.malformed

    def _compare(self, rows: Array, samples: Array) -> None:
        stamp, recorded = samples['stamp'], self._states.values[rows, : len(self.units)]
        if self.offset and 'position' in self.units:
            recorded = np.column_stack([recorded[:, 0] - self.offset, recorded[:, 1:]])
        self._faults.add(f'no joint {self.joint!r}', stamp[~self._states.joint_found[rows]])
        turns = samples['turns'] + self._unseen_turns(samples, recorded)
        least, most = np.stack(self._expected(samples, turns), axis=-1)
        # Any value between them is as expected.
        nearest = np.where(np.isfinite(recorded), np.clip(recorded, least, most), least)
        rotor_angle = TURN * turns + samples['angle']
        self._add_errors(rows, stamp, rotor_angle, recorded, nearest)

    def _unseen_turns(self, samples: Array, recorded: Array) -> Array | float:  # noqa: ARG002
        """The turns of the rotor to add to those of the samples, (n,)."""
        return self._unseen.of(samples['segment']) if self._unseen else 0.0

    def _expected(self, samples: Array, turns: Array) -> Sequence[tuple[Array, Array]]:
        """The least and the greatest value of each field; NaN where it is absent."""
        raise NotImplementedError

    def _add_errors(
        self, rows: Array, stamp: Array, rotor_angle: Array, recorded: Array, expected: Array
    ) -> None:
        """Add what was recorded and expected of the fields, (n, fields); NaN is not expected."""
        signed = recorded - expected
        fields = []
        for column, errors in enumerate(self.errors):
            wanted, there = ~np.isnan(expected[:, column]), self._states.present[rows, column]
            both, error = wanted & there, signed[:, column]
            errors.update(
                np.abs(error[both]), stamp[both], rotor_angle[both], absent=stamp[wanted != there]
            )
            part = slice(column, column + 1)
            samples = _samples(recorded[:, part], expected[:, part], error)
            fields.append(samples._replace(error=np.where(both, samples.error, np.nan)))
        self.series.update(stamp, rotor_angle, *fields)

    def _ideal_angle(self, turns: Array, angle: Array) -> Array:
        """The ideal output angle at rotor angles of 2π turns + angle, (n,), rad."""
        if isinstance(self._gear, Mechanism):
            return self._solver(self._gear, angle, rotor_turns=turns).output_angle
        output_turns, rest = self._gear.output_angle(turns, angle, np)
        return np.asarray(TURN * output_turns + rest)


STATE_UNITS = dict(zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True))
"""Units of the fields of a JointState by their names."""


def _samples(recorded: Array, expected: Array, error: Array) -> FieldSamples:
    return FieldSamples(recorded, expected, np.where(np.isfinite(error), error, np.inf))


class OutputState(JointStateTopic):
    """output_state."""

    units: ClassVar[Mapping[str, str]] = STATE_UNITS

    def __init__(self, name: str, joint: str, expectation: Expectation) -> None:
        super().__init__(name, joint, expectation)
        self.fit = AngleFit()
        self._factors = {'velocity': FactorFit(), 'effort': FactorFit()}

    def _unseen_turns(self, samples: Array, recorded: Array) -> Array | float:
        if not self._unseen:
            return 0.0
        expected = self._ideal_angle(samples['turns'], samples['angle'])
        self._unseen.learn_from_angles(samples['segment'], recorded[:, 0], expected)
        return self._unseen.of(samples['segment'])

    def _expected(self, samples: Array, turns: Array) -> Sequence[tuple[Array, Array]]:
        ratio = self._gear.gear_ratio
        angle = self._ideal_angle(turns, samples['angle'])
        velocity, effort = ratio.output_rate(samples['velocity']), float(ratio) * samples['effort']
        return (angle, angle), (velocity, velocity), (effort, effort)

    def _add_errors(
        self, rows: Array, stamp: Array, rotor_angle: Array, recorded: Array, expected: Array
    ) -> None:
        super()._add_errors(rows, stamp, rotor_angle, recorded, expected)
        for column, factor in enumerate(self._factors.values(), 1):
            factor.update(recorded[:, column], expected[:, column])
        error = recorded[:, 0] - expected[:, 0]
        usable = np.isfinite(error)
        stamp, rotor_angle, error = stamp[usable], rotor_angle[usable], error[usable]
        output_angle = recorded[usable, 0]
        self.fit.update(rotor_angle, output_angle, error)
        self.compared = {
            'stamp': stamp,
            'rotor_angle': rotor_angle,
            'output_angle': output_angle,
            'error': error,
        }

    def causes(self) -> Iterator[Finding]:
        """Yield what explains errors of the angle, or else of the velocity and the effort."""
        if not self.errors[0].report().passed:
            if text := diagnose(self._gear, self.fit, self._tolerances.angle):
                yield Finding(text, cause=True)
            return
        for field, fit in self._factors.items():
            if (factor := fit.factor()) is not None:
                yield Finding(describe_factor(field, factor, self._gear.gear_ratio), cause=True)


class BodyPoses(OutputTopic):
    """body_poses."""

    def __init__(
        self, name: str, frame_id: str, mechanism: Mechanism, expectation: Expectation
    ) -> None:
        branches = [branch.name for branch in mechanism.branches]
        tolerances = expectation.tolerances
        self._bodies = [f'{kind}_{b}' for kind in ('satellite', 'oldham') for b in branches]
        coordinates = [f'{body} {axis}' for body in self._bodies for axis in 'xyz']
        self.position = FieldErrors('position', 'm', tolerances.position, coordinates)
        self._orientation = FieldErrors('orientation', 'rad', tolerances.angle, self._bodies)
        super().__init__(name, expectation, self.position, self._orientation)
        self._mechanism = mechanism
        self.frame_id = frame_id
        self._axial = np.array([b.axial_position for b in mechanism.branches] * 2)
        self._order = PoseOrder(self._bodies, tolerances.position)
        self._negated = Faults()
        # Learned from this topic alone, which is less certain than from output_state.
        self._own_unseen = UnseenTurns(mechanism.gear_ratio, tolerances.angle)

    def causes(self) -> Iterator[Finding]:
        """Yield the other orders of the poses."""
        return self._order.causes(self.matcher.compared)

    def notes(self) -> Iterator[Finding]:
        """Yield quaternions with the other sign."""
        return self._negated.findings()

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._arrays: PoseArrays = decode_pose_arrays(messages, len(self._bodies))
        return self._arrays.stamp, self._arrays.malformed

    def _compare(self, rows: Array, samples: Array) -> None:
        arrays, stamp = self._arrays, samples['stamp']
        for k, frame_id in enumerate(arrays.frame_ids):
            if frame_id != self.frame_id.encode():
                name = frame_id.decode(errors='replace')
                framed = stamp[arrays.frame[rows] == k]
                self._faults.add(f'frame {name!r}, not {self.frame_id!r}', framed)
        poses = arrays.poses[rows] if len(rows) < len(arrays.poses) else arrays.poses
        turns = samples['turns'] + self._unseen_turns(samples, poses)
        state = self._solver(self._mechanism, samples['angle'], rotor_turns=turns)
        rotor_angle = TURN * turns + samples['angle']
        centres = np.concatenate([state.satellite_centre, state.oldham_centre], axis=1)
        planar = np.hypot(*np.moveaxis(poses[..., :2] - centres, -1, 0))
        position = np.hypot(planar, poses[..., 2] - self._axial).max(axis=1)
        self.position.update(position, stamp, rotor_angle)
        axial = np.broadcast_to(self._axial[:, np.newaxis], (*centres.shape[:2], 1))
        expected = np.append(centres, axial, axis=-1)
        self._order.update(poses[..., :3], expected, position, stamp)
        angle = state.output_turn_angle[:, np.newaxis]
        orientation = _orientation_error(poses[..., 3:], angle)
        self._orientation.update(orientation, stamp, rotor_angle)
        self._negated.add(
            'orientations with w < 0, the same rotations as those with w > 0 of this node',
            stamp[(poses[..., 6] < 0.0).any(axis=1)],
        )
        self.compared = {'stamp': stamp, 'error': position}
        recorded = 2.0 * np.arctan2(poses[..., 5], poses[..., 6])
        shape = len(rows), 3 * len(self._bodies)
        self.series.update(
            stamp,
            rotor_angle,
            _samples(poses[..., :3].reshape(shape), expected.reshape(shape), position),
            _samples(recorded - TURN * np.round((recorded - angle) / TURN), angle, orientation),
        )

    def _unseen_turns(self, samples: Array, poses: Array) -> Array | float:
        if not self._unseen:
            return 0.0
        segment = samples['segment']
        state = self._solver(self._mechanism, samples['angle'], rotor_turns=samples['turns'])
        recorded = 2.0 * np.arctan2(poses[:, 0, 5], poses[:, 0, 6])
        self._own_unseen.learn_from_poses(segment, recorded, state.output_turn_angle)
        return self._unseen.of(segment, otherwise=self._own_unseen.of(segment))


def _orientation_error(quaternions: Array, angle: Array) -> Array:
    """Return the greatest error of the bodies, (n,), rad.

    Args:
        quaternions: recorded, (n, bodies, 4).
        angle: expected about the z axis, (n, 1), rad.
    """
    x, y, z, w = np.moveaxis(quaternions, -1, 0)
    sine, cosine = np.sin(0.5 * angle), np.cos(0.5 * angle)
    # A quaternion and its negative are the same rotation.
    sign = np.where(z * sine + w * cosine < 0.0, -1.0, 1.0)
    about_z = np.maximum(np.abs(z - sign * sine), np.abs(w - sign * cosine))
    tilt = np.maximum(np.abs(x), np.abs(y))
    error: Array = 2.0 * np.maximum(about_z, tilt).max(axis=1)
    return error
