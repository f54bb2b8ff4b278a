"""What a node published, against what it should have published: one pass over a recording."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.diagnosis import diagnose
from gear_kinematics.input_health import InputHealth
from gear_kinematics.kinematics import Mechanism, MotionState, solve
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.matching import WINDOW, Window
from gear_kinematics.output_topics import BodyPoses, OutputState, Tolerances
from gear_kinematics.report import BagReport, InputReport, Verdict
from gear_kinematics.rotor_input import InputSettings, RotorInput, RotorSamples
from gear_kinematics.series import SeriesRecorder

__all__ = ['Message', 'Tolerances', 'Topics', 'Validator']

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


_TOPICS, _TOLERANCES = Topics(), Tolerances()


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
        topics: Topics = _TOPICS,
        tolerances: Tolerances = _TOLERANCES,
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
        self.output = OutputState(prefix + parameters['output_joint'], tolerances)
        self.poses = BodyPoses(prefix + 'stator', self._mechanism, tolerances)
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
            mechanism=self._mechanism,
            module=self._parameters['module'],
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


def _health_findings(rotor: InputReport) -> Iterable[str]:
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
