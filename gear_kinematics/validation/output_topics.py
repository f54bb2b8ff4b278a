"""Compares the fields of each output topic with recomputed ones, sample by sample."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, Mechanism, MotionState
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.validation.diagnosis import AngleFit, PoseOrder, UnseenTurns
from gear_kinematics.validation.factor import FactorFit, describe
from gear_kinematics.validation.field_errors import FieldErrors
from gear_kinematics.validation.matching import Columns, Faults, OutputTopic
from gear_kinematics.validation.series import FieldSamples
from gear_kinematics.wire.batches import (
    FIELDS,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)

Array = NDArray[Any]

Solver = Callable[..., MotionState]


class Tolerances(NamedTuple):
    """Greatest accepted errors."""

    angle: float = 1e-9
    """rad for angles, rad/s for the velocity, N·m for the effort."""
    position: float = 1e-9
    """m."""


class JointStateTopic(OutputTopic):
    """An output topic of JointStates with one joint; its fields are compared one by one."""

    units: ClassVar[Mapping[str, str]]
    """Units of the fields by their names."""

    def __init__(
        self,
        joint: str,
        gear: Gear,
        tolerances: Tolerances,
        solver: Solver,
        unseen: UnseenTurns | None,
    ) -> None:
        super().__init__(
            unseen,
            *(FieldErrors(name, unit, tolerances.angle) for name, unit in self.units.items()),
        )
        self._gear = gear
        self._solver = solver
        self.joint = joint
        self.offset = 0.0
        """Known offset of the recorded angle, rad."""

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._states = decode_joint_states(messages, self.joint)
        return self._states.stamp, self._states.malformed

    def _note_strangers(self, rows: Array, stamp: Array) -> None:
        """Count the messages without the joint."""
        self._faults.add(f'no joint {self.joint!r}', stamp[~self._states.joint_found[rows]])

    def _add_errors(
        self,
        rows: Array,
        stamp: Array,
        rotor_angle: Array,
        recorded: Array,
        expected: Array,
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

    def __init__(self, *arguments: Any) -> None:
        """Take the arguments of `JointStateTopic`."""
        super().__init__(*arguments)
        self.fit = AngleFit()
        self._factors = {'velocity': FactorFit(), 'effort': FactorFit()}
        self.position = self.errors[0]

    def _compare(self, rows: Array, samples: Columns) -> None:
        stamp, stretch = samples['stamp'], samples['stretch']
        self._note_strangers(rows, stamp)
        recorded = self._states.values[rows] - (self.offset, 0.0, 0.0)
        unseen_turns: Array | float = 0.0
        if self._unseen:
            expected = self._ideal_angle(samples['turns'], samples['angle'])
            self._unseen.learn_from_angles(stretch, recorded[:, 0], expected)
            unseen_turns = self._unseen.of(stretch)
        turns = samples['turns'] + unseen_turns
        angle = self._ideal_angle(turns, samples['angle'])
        rotor_angle = TURN * turns + samples['angle']
        velocity = self._gear.gear_ratio.output_rate(samples['velocity'])
        effort = float(self._gear.gear_ratio) * samples['effort']
        needed = np.stack([angle, velocity, effort], axis=-1)
        self._add_errors(rows, stamp, rotor_angle, recorded, needed)
        for column, fit in enumerate(self._factors.values(), 1):
            fit.update(recorded[:, column], needed[:, column])
        error = recorded[:, 0] - needed[:, 0]
        usable = np.isfinite(error)
        self.fit.update(rotor_angle[usable], recorded[usable, 0], error[usable])
        self.compared = {
            'stamp': stamp[usable],
            'rotor_angle': rotor_angle[usable],
            'output_angle': recorded[usable, 0],
            'error': error[usable],
        }

    def factors(self) -> Iterator[str]:
        """Describe constant factors of the velocity and the effort, in sentences."""
        for field, fit in self._factors.items():
            if (factor := fit.factor()) is not None:
                yield describe(field, factor, self._gear.gear_ratio)


class BodyPoses(OutputTopic):
    """body_poses."""

    def __init__(
        self,
        frame_id: str,
        mechanism: Mechanism,
        tolerances: Tolerances,
        solver: Solver,
        unseen: UnseenTurns | None,
    ) -> None:
        branches = [branch.name for branch in mechanism.branches]
        self._bodies = [f'{kind}_{b}' for kind in ('satellite', 'oldham') for b in branches]
        coordinates = [f'{body} {axis}' for body in self._bodies for axis in 'xyz']
        self._position = FieldErrors('position', 'm', tolerances.position, coordinates)
        self._orientation = FieldErrors('orientation', 'rad', tolerances.angle, self._bodies)
        super().__init__(unseen, self._position, self._orientation)
        self._mechanism = mechanism
        self._solver = solver
        self.frame_id = frame_id
        self._axial = np.array([b.axial_position for b in mechanism.branches] * 2)
        self._order = PoseOrder(self._bodies, tolerances.position)
        self._turned_round = Faults()
        # Learned from this topic alone, which is less certain than from output_state.
        self._own_unseen = UnseenTurns(mechanism.gear_ratio, tolerances.angle)

    @property
    def worst_error(self) -> float:
        """Greatest position error, m."""
        return self._position.worst

    def order(self) -> Iterator[str]:
        """Describe poses in another order, in sentences."""
        return self._order.findings(self.matcher.compared)

    def turned_round(self) -> tuple[str, ...]:
        """Describe quaternions with the other sign, in sentences."""
        return self._turned_round.sentences()

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._arrays: PoseArrays = decode_pose_arrays(messages, len(self._bodies))
        return self._arrays.stamp, self._arrays.malformed

    def _compare(self, rows: Array, samples: Columns) -> None:
        arrays, stamp = self._arrays, samples['stamp']
        for k, frame_id in enumerate(arrays.frame_ids):
            if frame_id != self.frame_id.encode():
                name = frame_id.decode(errors='replace')
                strangers = stamp[arrays.frame[rows] == k]
                self._faults.add(f'frame {name!r}, not {self.frame_id!r}', strangers)
        poses = arrays.poses[rows] if len(rows) < len(arrays.poses) else arrays.poses
        turns = samples['turns'] + self._unseen_turns(poses, samples)
        state = self._solver(self._mechanism, samples['angle'], rotor_turns=turns)
        rotor_angle = TURN * turns + samples['angle']
        centres = np.concatenate([state.satellite_centre, state.oldham_centre], axis=1)
        planar = np.hypot(*np.moveaxis(poses[..., :2] - centres, -1, 0))
        position = np.hypot(planar, poses[..., 2] - self._axial).max(axis=1)
        self._position.update(position, stamp, rotor_angle)
        axial = np.broadcast_to(self._axial[:, np.newaxis], (*centres.shape[:2], 1))
        expected = np.append(centres, axial, axis=-1)
        self._order.update(poses[..., :3], expected, position, stamp)
        # A quaternion and its negative are the same rotation.
        half = 0.5 * state.output_turn_angle[:, np.newaxis]
        sine, cosine = np.sin(half), np.cos(half)
        sign = np.where(poses[..., 5] * sine + poses[..., 6] * cosine < 0.0, -1.0, 1.0)
        off = np.maximum(
            np.abs(poses[..., 5] - sign * sine), np.abs(poses[..., 6] - sign * cosine)
        )
        tilt = np.maximum(np.abs(poses[..., 3]), np.abs(poses[..., 4]))
        orientation = 2.0 * np.maximum(off, tilt).max(axis=1)
        self._orientation.update(orientation, stamp, rotor_angle)
        self._turned_round.add(
            'orientations with w < 0, the same rotations as those with w > 0 of this node',
            stamp[(poses[..., 6] < 0.0).any(axis=1)],
        )
        self.compared = {'stamp': stamp, 'error': position}
        angle = state.output_turn_angle[:, np.newaxis]
        recorded = 2.0 * np.arctan2(poses[..., 5], poses[..., 6])
        shape = len(rows), 3 * len(self._bodies)
        self.series.update(
            stamp,
            rotor_angle,
            _samples(poses[..., :3].reshape(shape), expected.reshape(shape), position),
            _samples(
                recorded - TURN * np.round((recorded - angle) / TURN),
                np.broadcast_to(angle, recorded.shape),
                orientation,
            ),
        )

    def _unseen_turns(self, poses: Array, samples: Columns) -> Array | float:
        if not self._unseen:
            return 0.0
        stretch = samples['stretch']
        self._own_unseen.learn_from_poses(
            stretch,
            2.0 * np.arctan2(poses[:, 0, 5], poses[:, 0, 6]),
            self._solver(
                self._mechanism, samples['angle'], rotor_turns=samples['turns']
            ).output_turn_angle,
        )
        return self._unseen.of(stretch, otherwise=self._own_unseen.of(stretch))
