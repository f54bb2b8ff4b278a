"""The output topics of a recording, compared with what was recomputed, batch by batch."""

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.diagnosis import AngleFit, pose_order
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.matching import Matcher, Window
from gear_kinematics.message_batches import (
    FIELDS,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)
from gear_kinematics.report import FieldReport, TopicReport

Array = NDArray[Any]


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Greatest errors that pass."""

    angle: float = 1e-9
    """rad, of angles; rad/s of the velocity and N·m of the effort."""
    position: float = 1e-9
    """m."""


class FieldErrors:
    """The errors of one field, gathered batch by batch."""

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

    def update(self, error: Array, stamp: Array, rotor_angle: Array, absent: int = 0) -> bool:
        """Take absolute errors (n,); tells whether the worst of all is among them."""
        report = self._report
        finite = np.isfinite(error)
        if not finite.all():
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        self._squares += float(error @ error)
        self._report = report = replace(
            report,
            compared=report.compared + len(finite),
            non_finite=report.non_finite + len(finite) - len(error),
            absent=report.absent + absent,
        )
        if not len(error):
            return False
        worst = int(np.argmax(error))
        if error[worst] <= report.max_error:
            return False
        self._report = replace(
            report,
            max_error=float(error[worst]),
            worst_stamp=int(stamp[worst]),
            worst_rotor_angle=float(rotor_angle[worst]),
        )
        return True

    def report(self) -> FieldReport:
        """Report on everything so far."""
        finite = self._report.compared - self._report.non_finite
        return replace(
            self._report, rms_error=math.sqrt(self._squares / finite) if finite else 0.0
        )


class OutputTopic:
    """One output topic: matching, what is wrong with its messages as such, and late ones."""

    def __init__(self) -> None:
        self.matcher = Matcher()
        self.compared: dict[str, Array] = {}
        """What the last batch compared, for the series."""
        self._faults: Counter[str] = Counter()
        self._late: list[bytes] = []

    def take(self, messages: list[bytes], window: Window) -> None:
        """Compare new messages with the samples of the window."""
        columns = window.columns
        late = self._late
        stamps, malformed = self._decode(late + messages)
        self.matcher.see(stamps[len(late) :])
        usable = np.flatnonzero(~malformed)
        if len(usable) < len(stamps):
            self._faults['malformed'] += len(stamps) - len(usable)
        index = self.matcher.match(stamps[usable], columns['stamp'])
        found = index >= 0
        # A message can be recorded before the input that it answers: it waits for one batch.
        self.matcher.give_up(stamps[usable[~found & (usable < len(late))]])
        waiting = usable[~found & (usable >= len(late))] - len(late)
        self._late = [messages[row] for row in waiting.tolist()]
        rows, index = usable[found], index[found]
        self._compare(rows, {name: column[index] for name, column in columns.items()})

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        raise NotImplementedError

    def _compare(self, rows: Array, expected: dict[str, Array]) -> None:
        raise NotImplementedError

    def _fields(self) -> tuple[FieldErrors, ...]:
        raise NotImplementedError

    def report(self, topic: str) -> TopicReport:
        """Report on everything so far."""
        matcher = self.matcher
        return TopicReport(
            topic,
            messages=matcher.messages,
            compared=matcher.compared,
            missing=matcher.missing,
            extra=matcher.extra,
            duplicates=matcher.duplicates,
            out_of_order=matcher.out_of_order,
            fields=tuple(errors.report() for errors in self._fields()),
            first_missing=matcher.first_missing,
            first_extra=matcher.first_extra,
            faults=tuple(f'{fault}: {count} messages' for fault, count in self._faults.items()),
        )


class OutputState(OutputTopic):
    """output_state."""

    def __init__(self, joint: str, tolerances: Tolerances) -> None:
        super().__init__()
        self.fit = AngleFit()
        self.offset = 0.0
        """rad, which the recorded angle is known to be off by."""
        self._joint = joint
        self._errors = tuple(
            FieldErrors(name, unit, tolerances.angle)
            for name, unit in zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True)
        )
        self.position = self._errors[0]

    def _fields(self) -> tuple[FieldErrors, ...]:
        return self._errors

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._states = decode_joint_states(messages, self._joint)
        return self._states.stamp, self._states.malformed

    def _compare(self, rows: Array, expected: dict[str, Array]) -> None:
        states = self._states
        if strangers := int(np.count_nonzero(~states.joint_found[rows])):
            self._faults[f'no joint {self._joint!r}'] += strangers
        stamp, rotor_angle = expected['stamp'], expected['rotor_angle']
        recorded = states.values[rows] - (self.offset, 0.0, 0.0)
        signed = recorded - expected['output']
        for column, errors in enumerate(self._errors):
            wanted = ~np.isnan(expected['output'][:, column])
            there = states.present[rows, column]
            both = wanted & there
            errors.update(
                np.abs(signed[both, column]),
                stamp[both],
                rotor_angle[both],
                absent=int(np.count_nonzero(wanted != there)),
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

    def __init__(self, frame_id: str, mechanism: Mechanism, tolerances: Tolerances) -> None:
        super().__init__()
        self._frame_id = frame_id
        branches = [branch.name for branch in mechanism.branches]
        self._bodies = [f'{kind}_{b}' for kind in ('satellite', 'oldham') for b in branches]
        self._axial = np.array([b.axial_position for b in mechanism.branches] * 2)
        self._tolerance = tolerances.position
        self._position = FieldErrors('position', 'm', tolerances.position)
        self._orientation = FieldErrors('orientation', 'rad', tolerances.angle)
        self._worst: tuple[Array, Array] | None = None

    @property
    def worst_error(self) -> float:
        """Of position, m."""
        return self._position.worst

    def order(self) -> str | None:
        """Name the order of the poses where it is another than it should be."""
        if self._worst is None or self._position.passed:
            return None
        return pose_order(self._bodies, *self._worst, tolerance=self._tolerance)

    def _fields(self) -> tuple[FieldErrors, ...]:
        return self._position, self._orientation

    def _decode(self, messages: list[bytes]) -> tuple[Array, Array]:
        self._arrays: PoseArrays = decode_pose_arrays(messages, len(self._bodies))
        return self._arrays.stamp, self._arrays.malformed

    def _compare(self, rows: Array, expected: dict[str, Array]) -> None:
        arrays, stamp = self._arrays, expected['stamp']
        for k, frame_id in enumerate(arrays.frame_ids):
            if frame_id != self._frame_id.encode():
                strangers = int(np.count_nonzero(arrays.frame[rows] == k))
                if strangers:
                    name = frame_id.decode(errors='replace')
                    self._faults[f'frame {name!r}, not {self._frame_id!r}'] += strangers
        poses = arrays.poses[rows] if len(rows) < len(arrays.poses) else arrays.poses
        planar = poses[..., :2] - expected['centres']
        along = poses[..., 2] - self._axial
        distances = np.sqrt(planar[..., 0] ** 2 + planar[..., 1] ** 2 + along**2)
        position = distances.max(axis=1)
        if self._position.update(position, stamp, expected['rotor_angle']):
            worst = int(np.argmax(np.where(np.isfinite(position), position, -1.0)))
            centres = np.column_stack([expected['centres'][worst], self._axial])
            self._worst = poses[worst, :, :3].copy(), centres
        # A quaternion and its negative are the same rotation.
        sine, cosine = (expected['half_turn'][:, k, np.newaxis] for k in (0, 1))
        sign = np.where(poses[..., 5] * sine + poses[..., 6] * cosine < 0.0, -1.0, 1.0)
        off = np.maximum(
            np.abs(poses[..., 5] - sign * sine), np.abs(poses[..., 6] - sign * cosine)
        )
        tilt = np.maximum(np.abs(poses[..., 3]), np.abs(poses[..., 4]))
        orientation = 2.0 * np.maximum(off, tilt).max(axis=1)
        self._orientation.update(orientation, stamp, expected['rotor_angle'])
        self.compared = {'stamp': stamp, 'error': position}
