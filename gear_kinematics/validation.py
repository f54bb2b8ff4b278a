"""What a node published, against what it should have published: one pass over a recording."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.diagnosis import AngleFit, diagnose, pose_order
from gear_kinematics.input_health import InputHealth
from gear_kinematics.kinematics import Mechanism, MotionState, solve
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.matching import WINDOW, Matcher, Window
from gear_kinematics.message_batches import (
    FIELDS,
    PoseArrays,
    decode_joint_states,
    decode_pose_arrays,
)
from gear_kinematics.report import BagReport, FieldReport, TopicReport, Verdict
from gear_kinematics.rotor_input import InputSettings, RotorInput, RotorSamples
from gear_kinematics.series import SeriesRecorder

Array = NDArray[Any]
Message = tuple[str, int, bytes]
"""Topic, received (ns), CDR."""

Solver = Callable[..., MotionState]

_BATCH = 8192  # messages


@dataclass(frozen=True, slots=True)
class Topics:
    """The names of the topics in the recording."""

    rotor: str = '/rotor_state'
    output: str = '/output_state'
    poses: str = '/body_poses'

    def names(self) -> tuple[str, str, str]:
        """All three."""
        return self.rotor, self.output, self.poses


@dataclass(frozen=True, slots=True)
class Tolerances:
    """Greatest errors that pass."""

    angle: float = 1e-9
    """rad, of angles; rad/s of the velocity and N·m of the effort."""
    position: float = 1e-9
    """m."""


@dataclass(slots=True)
class _Batch:
    """Messages by topic."""

    rotor: list[bytes] = field(default_factory=list)
    received: list[int] = field(default_factory=list)
    """ns, of the rotor messages."""
    output: list[bytes] = field(default_factory=list)
    poses: list[bytes] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.rotor) + len(self.output) + len(self.poses)


class Validator:
    """Recomputes the outputs from the rotor topic and compares them with the recorded ones."""

    def __init__(
        self,
        parameters: Mapping[str, Any],
        *,
        topics: Topics = Topics(),
        tolerances: Tolerances = Tolerances(),
        allow_offset: bool = False,
        solver: Solver = solve,
    ) -> None:
        """Prepare for a recording.

        Args:
            parameters: of the node, as `parameters.load` gives them.
            topics: their names.
            tolerances: greatest errors that pass.
            allow_offset: accept a constant offset of the output angle, as homing leaves it.
            solver: what recomputes the motion: `solve`, or the matrix method's.

        Raises:
            MechanismError: if the parameters describe no mechanism.
        """
        self._parameters = dict(parameters)
        self._topics = topics
        self._tolerances = tolerances
        self._offset_open = allow_offset
        self._solver = solver
        self._mechanism = Mechanism.from_mapping(parameters)
        self._form = closed_form(self._mechanism)
        self._input = RotorInput(InputSettings.from_mapping(parameters))
        self._health = InputHealth(parameters['max_rotor_speed'])
        self._window = Window()
        prefix = parameters['frame_prefix']
        self.output = _OutputState(prefix + parameters['output_joint'], tolerances)
        self.poses = _BodyPoses(prefix + 'stator', self._mechanism, tolerances)
        self._series = SeriesRecorder()
        self._findings: list[str] = []

    def feed(
        self, messages: Iterable[Message], progress: Callable[[int], None] | None = None
    ) -> None:
        """Take the messages of the recording, on the three topics.

        What came before an exception of the iterable is taken all the same.

        Args:
            messages: in the order of their reception.
            progress: called with the number of messages of each batch.
        """
        source = iter(messages)
        count = 1
        while count:
            batch = _Batch()
            by_topic = dict(
                zip(self._topics.names(), (batch.rotor, batch.output, batch.poses), strict=True)
            )
            try:
                for topic, received, data in islice(source, _BATCH):
                    by_topic[topic].append(data)
                    if topic == self._topics.rotor:
                        batch.received.append(received)
            finally:
                self._take(batch)
            count = len(batch)
            if progress:
                progress(count)

    def report(self, bag: str = '', *, error: str | None = None) -> BagReport:
        """Report on everything that was fed; to be called once, at the end.

        Args:
            bag: its name.
            error: what cut the recording short, if anything did.
        """
        self._close()
        rotor = self._health.report(self._input, self._topics.rotor)
        topics = (
            self.output.report(self._topics.output),
            self.poses.report(self._topics.poses),
        )
        if error is None and not rotor.valid:
            error = 'no usable rotor states in it'
        elif error is None and not any(topic.messages for topic in topics):
            error = 'no outputs in it'
        passed = all(topic.passed for topic in topics)
        return BagReport(
            bag=bag,
            verdict=Verdict.UNUSABLE if error else Verdict.PASS if passed else Verdict.FAIL,
            gear_ratio=str(self._mechanism.gear_ratio),
            error=error,
            messages=rotor.messages + sum(topic.messages for topic in topics),
            rotor=rotor,
            topics=topics,
            findings=(*self._findings, *self._diagnoses(), *_health_findings(rotor)),
            series=self._series.series(),
        )

    def _take(self, batch: '_Batch') -> None:
        if self._offset_open and len(batch):
            self._settle_offset(batch)
        self._expect(self._input.accept_batch(batch.rotor, batch.received))
        self.output.take(batch.output, self._window)
        self.poses.take(batch.poses, self._window)
        stamps = self._window.columns['stamp']
        self._series.update(self.output.compared, self.poses.compared)
        done = self.output.matcher.matched & self.poses.matcher.matched
        settled = len(done) if done.all() else int(np.argmin(done))
        self._drop(max(settled, len(stamps) - WINDOW))

    def _expect(self, samples: RotorSamples) -> None:
        """Recompute the outputs of the samples and put them into the window."""
        state = self._solver(self._mechanism, samples.angle, rotor_turns=samples.turns)
        rotor_angle = TURN * samples.turns + samples.angle
        self._health.update(samples.stamp, rotor_angle)
        half = 0.5 * state.output_turn_angle
        effort = float(self._mechanism.gear_ratio) * samples.effort
        self._window.append(
            stamp=samples.stamp,
            rotor_angle=rotor_angle,
            output=np.stack(
                [state.output_angle, self._form.output_rate(samples.velocity), effort], axis=-1
            ),
            centres=np.concatenate([state.satellite_centre, state.oldham_centre], axis=1),
            half_turn=np.stack([np.sin(half), np.cos(half)], axis=-1),
        )
        self.output.matcher.extend(len(samples.stamp))
        self.poses.matcher.extend(len(samples.stamp))

    def _drop(self, count: int) -> None:
        stamps = self._window.columns['stamp']
        self.output.matcher.drop(count, stamps)
        self.poses.matcher.drop(count, stamps)
        self._window.drop(count)

    def _close(self) -> None:
        """Nothing comes any more: what waits is missing or extra."""
        for _ in range(2):  # what was late waits for one batch more
            self._take(_Batch())
        self._drop(len(self._window))

    def _settle_offset(self, batch: '_Batch') -> None:
        """Find out, from the first batch with outputs, whether there is an offset to accept.

        Homing moves the rotor's zero, and so the poses too; if the poses are better without that,
        the output angle alone is offset.
        """
        trial = self._trial(batch, {})
        if not trial.output.fit.count:
            return
        self._offset_open = False
        offset = trial.output.fit.offset(self._tolerances.angle)
        if offset is None:
            return
        direction, zero = self._parameters['rotor_direction'], self._parameters['rotor_zero']
        moved = {'rotor_zero': zero - direction * self._mechanism.rotor_angle(offset)}
        homed = self._trial(batch, moved)
        if homed.poses.worst_error <= trial.poses.worst_error:
            self._input.settings = replace(self._input.settings, **moved)
        else:
            self.output.offset = offset
        self._findings.append(
            f'accepted: the recorded output angle is off by a constant {offset:.12g} rad'
        )

    def _trial(self, batch: '_Batch', changes: Mapping[str, Any]) -> 'Validator':
        trial = Validator(
            {**self._parameters, **changes},
            topics=self._topics,
            tolerances=self._tolerances,
            solver=self._solver,
        )
        trial._take(batch)
        return trial

    def _diagnoses(self) -> Iterable[str]:
        if not self.output.position.passed:
            found = diagnose(self._mechanism, self.output.fit, self._tolerances.angle)
            if found:
                yield found
        if found := self.poses.order():
            yield found


class _Errors:
    """The errors of one field, gathered batch by batch."""

    def __init__(self, name: str, unit: str, tolerance: float) -> None:
        self._report = FieldReport(name, unit, tolerance)
        self._squares = 0.0

    @property
    def passed(self) -> bool:
        return self._report.passed

    @property
    def worst(self) -> float:
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
        finite = self._report.compared - self._report.non_finite
        return replace(
            self._report, rms_error=math.sqrt(self._squares / finite) if finite else 0.0
        )


class _Output:
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

    def _fields(self) -> tuple[_Errors, ...]:
        raise NotImplementedError

    def report(self, topic: str) -> TopicReport:
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


class _OutputState(_Output):
    """output_state."""

    def __init__(self, joint: str, tolerances: Tolerances) -> None:
        super().__init__()
        self.fit = AngleFit()
        self.offset = 0.0
        """rad, which the recorded angle is known to be off by."""
        self._joint = joint
        self._errors = tuple(
            _Errors(name, unit, tolerances.angle)
            for name, unit in zip(FIELDS, ('rad', 'rad/s', 'N·m'), strict=True)
        )
        self.position = self._errors[0]

    def _fields(self) -> tuple[_Errors, ...]:
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


class _BodyPoses(_Output):
    """body_poses."""

    def __init__(self, frame_id: str, mechanism: Mechanism, tolerances: Tolerances) -> None:
        super().__init__()
        self._frame_id = frame_id
        branches = [branch.name for branch in mechanism.branches]
        self._bodies = [f'{kind}_{b}' for kind in ('satellite', 'oldham') for b in branches]
        self._axial = np.array([b.axial_position for b in mechanism.branches] * 2)
        self._tolerance = tolerances.position
        self._position = _Errors('position', 'm', tolerances.position)
        self._orientation = _Errors('orientation', 'rad', tolerances.angle)
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

    def _fields(self) -> tuple[_Errors, ...]:
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


def _health_findings(rotor: Any) -> Iterable[str]:
    if rotor.jumps:
        yield (
            f'{rotor.jumps} gaps of {rotor.topic} could hide a turn of the single-turn encoder: '
            'from there on its turns are not known'
        )
    if rotor.overspeed:
        yield (
            f'{rotor.overspeed} steps of {rotor.topic} are faster than max_rotor_speed, at most '
            f'{rotor.max_speed:.4g} rad/s'
        )
    if rotor.zero_stamps:
        yield (
            f'{rotor.zero_stamps} messages of {rotor.topic} have no stamp: the node stamped their '
            'outputs itself, and they cannot be matched'
        )
