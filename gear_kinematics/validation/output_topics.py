"""Compares the fields of each output topic with recomputed ones, sample by sample."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Gear, Mechanism, MotionState
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.validation.diagnosis import AngleFit, PoseOrder, UnseenTurns
from gear_kinematics.validation.matching import Columns, Faults, OutputTopic
from gear_kinematics.validation.report import FieldReport
from gear_kinematics.wire.batches import (
    FIELDS,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)

Array = NDArray[Any]

Solver = Callable[..., MotionState]

_NONE = np.zeros(0, np.int64)


class Tolerances(NamedTuple):
    """Greatest accepted errors."""

    angle: float = 1e-9
    """rad for angles, rad/s for the velocity, N·m for the effort."""
    position: float = 1e-9
    """m."""


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(self, name: str, unit: str, tolerance: float) -> None:
        self._report = FieldReport(name, unit, tolerance)
        self._squares = 0.0

    @property
    def passed(self) -> bool:
        """Whether every sample so far is within the tolerance."""
        return self._report.passed

    @property
    def worst(self) -> float:
        """The greatest error so far."""
        return self._report.max_error

    def update(
        self, error: Array, stamp: Array, rotor_angle: Array, absent: Array = _NONE
    ) -> None:
        """Add absolute errors (n,), and the stamps of samples that lack the field, (m,)."""
        report = self._report
        finite = np.isfinite(error)
        self._report = report = replace(
            report,
            compared=report.compared + len(error),
            non_finite=report.non_finite + int(np.count_nonzero(~finite)),
            first_non_finite=_first(report.first_non_finite, stamp[~finite]),
            absent=report.absent + len(absent),
            first_absent=_first(report.first_absent, absent),
        )
        if not finite.all():
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        self._squares += float(error @ error)
        if not len(error):
            return
        worst = int(np.argmax(error))
        if error[worst] <= report.max_error:
            return
        self._report = replace(
            report,
            max_error=float(error[worst]),
            worst_stamp=int(stamp[worst]),
            worst_rotor_angle=float(rotor_angle[worst]),
        )

    def report(self) -> FieldReport:
        """Report on everything so far."""
        finite = self._report.compared - self._report.non_finite
        return replace(
            self._report, rms_error=math.sqrt(self._squares / finite) if finite else 0.0
        )


def _first(known: int | None, stamps: Array) -> int | None:
    return int(stamps[0]) if known is None and len(stamps) else known


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
        super().__init__(unseen)
        self._gear = gear
        self._solver = solver
        self.joint = joint
        self.offset = 0.0
        """Known offset of the recorded angle, rad."""
        self._errors = tuple(
            FieldErrors(name, unit, tolerances.angle) for name, unit in self.units.items()
        )

    def _fields(self) -> tuple[FieldReport, ...]:
        return tuple(errors.report() for errors in self._errors)

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
        compared: Iterable[tuple[Array, Array]],
    ) -> None:
        """Add the errors of the fields: for each whether it is wanted, and its error, (n,)."""
        for column, (errors, (wanted, error)) in enumerate(
            zip(self._errors, compared, strict=True)
        ):
            there = self._states.present[rows, column]
            both = wanted & there
            errors.update(
                error[both], stamp[both], rotor_angle[both], absent=stamp[wanted != there]
            )

    def _ideal_angle(self, turns: Array, angle: Array) -> Array:
        """The ideal output angle at rotor angles of 2π turns + angle, (n,), rad."""
        if isinstance(self._gear, Mechanism):
            return self._solver(self._gear, angle, rotor_turns=turns).output_angle
        output_turns, rest = self._gear.output_angle(turns, angle, np)
        return np.asarray(TURN * output_turns + rest)


STATE_UNITS = dict(zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True))
"""Units of the fields of a JointState by their names."""


class OutputState(JointStateTopic):
    """output_state."""

    units: ClassVar[Mapping[str, str]] = STATE_UNITS

    def __init__(self, *arguments: Any) -> None:
        """Take the arguments of `JointStateTopic`."""
        super().__init__(*arguments)
        self.fit = AngleFit()
        self.position = self._errors[0]

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
        signed = recorded - needed
        self._add_errors(
            rows, stamp, rotor_angle, zip(~np.isnan(needed.T), np.abs(signed.T), strict=True)
        )
        usable = np.isfinite(signed[:, 0])
        self.fit.update(rotor_angle[usable], recorded[usable, 0], signed[usable, 0])
        self.compared = {
            'stamp': stamp[usable],
            'rotor_angle': rotor_angle[usable],
            'output_angle': recorded[usable, 0],
            'error': signed[usable, 0],
        }


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
        super().__init__(unseen)
        self._mechanism = mechanism
        self._solver = solver
        self.frame_id = frame_id
        branches = [branch.name for branch in mechanism.branches]
        self._bodies = [f'{kind}_{b}' for kind in ('satellite', 'oldham') for b in branches]
        self._axial = np.array([b.axial_position for b in mechanism.branches] * 2)
        self._position = FieldErrors('position', 'm', tolerances.position)
        self._orientation = FieldErrors('orientation', 'rad', tolerances.angle)
        self._order = PoseOrder(self._bodies, tolerances.position)
        self._turned_round = Faults()
        # Learned from this topic alone, which is less certain than from output_state.
        self._own_unseen = UnseenTurns(mechanism.gear_ratio, tolerances.angle)

    @property
    def worst_error(self) -> float:
        """Greatest position error, m."""
        return self._position.worst

    def findings(self) -> tuple[str, ...]:
        """Describe the order of the poses and the signs of quaternions, in sentences."""
        return (*self._order.findings(self.matcher.compared), *self._turned_round.sentences())

    def _fields(self) -> tuple[FieldReport, ...]:
        return self._position.report(), self._orientation.report()

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
        self._order.update(poses[..., :3], np.append(centres, axial, axis=-1), position, stamp)
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
