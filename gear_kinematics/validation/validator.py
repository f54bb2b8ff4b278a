"""Compares the outputs of a node with recomputed ones, in one pass over a recording."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import Message, ReportProgress, TopicMessages, in_batches, sort_by_topic
from gear_kinematics.bag.roles import Topics
from gear_kinematics.kinematics import Mechanism, gear_from_mapping, solve
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.rotor_input import InputSettings, RotorInput
from gear_kinematics.validation import checks
from gear_kinematics.validation.diagnosis import UnseenTurns, diagnose
from gear_kinematics.validation.matching import WINDOW, OutputTopic, Window
from gear_kinematics.validation.output_topics import BodyPoses, OutputState, Solver, Tolerances
from gear_kinematics.validation.recorder import Completeness, Inputs, RecordedInputs
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.timeline import InputHealth, SeriesRecorder
from gear_kinematics.wire.cdr import MalformedMessageError, joint_state_layout, pose_array_layout

Array = NDArray[Any]

_FRAME = 'stator'
_TOPICS, _TOLERANCES = Topics(), Tolerances()
_Batch = tuple[TopicMessages, ...]
"""Messages in the order of `Topics`."""


class Validator:
    """Recomputes the outputs from the rotor topic and compares them with the recorded ones."""

    def __init__(
        self,
        parameters: Mapping[str, Any],
        *,
        topics: Topics = _TOPICS,
        tolerances: Tolerances = _TOLERANCES,
        allow_offset: bool = False,
        strict: bool = False,
        solver: Solver = solve,
    ) -> None:
        """Prepare for a recording.

        Args:
            parameters: of the node, as `parameters.load` returns them.
            topics: names of the topics.
            tolerances: greatest accepted errors.
            allow_offset: whether to accept a constant offset of the output angle, as after homing.
            strict: whether to judge all missing and extra messages, even if the recorder may have
                caused them; see `recorder`.
            solver: recomputes the motion: `solve`, or that of the matrix method.

        Raises:
            ValueError: if the parameters describe no gear.
        """
        self._parameters = dict(parameters)
        self._prefix_open = not parameters['frame_prefix']
        self._topics = topics
        self._tolerances = tolerances
        self._offset_open = allow_offset
        self._solver = solver
        self._strict = strict
        self._gear = gear = gear_from_mapping(parameters)
        self._input = RotorInput(InputSettings.from_mapping(parameters))
        self._health = InputHealth(parameters['max_rotor_speed'])
        self._window = Window()
        self._inputs = RecordedInputs(strict=strict)
        self._begun: dict[str, int] = {}  # when the first message of each topic was received, ns
        single_turn = self._input.settings.single_turn
        self._unseen = UnseenTurns(gear.gear_ratio, tolerances.angle) if single_turn else None
        prefix = parameters['frame_prefix']
        common = tolerances, solver, self._unseen
        self.output = OutputState(prefix + parameters['output_joint'], gear, *common)
        self.poses = None
        self._outputs: tuple[OutputTopic, ...] = (self.output,)
        if isinstance(gear, Mechanism):
            self.poses = BodyPoses(prefix + _FRAME, gear, *common)
            self._outputs = self.output, self.poses
        self._absences = Completeness(len(self._outputs), strict=strict)
        self._series = SeriesRecorder()
        self._checks = [make(parameters) for make in checks.CHECKS]
        self._findings: list[str] = []

    def feed(
        self,
        messages: Iterable[Message],
        progress: ReportProgress | None = None,
        total: int | None = None,
    ) -> None:
        """Process messages on the three topics, up to an exception of the iterable, if any.

        Args:
            messages: in the order of their reception.
            progress: called after each batch.
            total: number of the messages, if known.
        """
        for recorded in in_batches(messages, progress=progress, total=total):
            batch = _empty_batch()
            sort_by_topic(recorded, dict(zip(self._topics, batch, strict=True)))
            self._take(batch)

    @np.errstate(all='ignore')  # recorded numbers are arbitrary; overflows fail
    def report(self, bag: str = '', *, error: str | None = None) -> BagReport:
        """Return the report on all messages; must be called once, at the end.

        Args:
            bag: name of the bag.
            error: damage at which reading ended, if any.
        """
        self._close()
        rotor = self._health.report(self._input, self._topics.rotor)
        topics = tuple(
            output.report(topic, lacks)
            for output, topic, lacks in zip(
                self._outputs, self._topics[1:], self._absences.topics, strict=False
            )
        )
        if error is None and not rotor.valid:
            error = 'no usable rotor states in it'
        elif error is None and not any(topic.messages for topic in topics):
            error = 'no outputs in it'
        judgements = [found for check in self._checks for found in check.judge(rotor)]
        failed = any(judgement.fails for judgement in judgements)
        passed = all(topic.passed for topic in topics) and not failed
        return BagReport(
            bag=bag,
            verdict=Verdict.UNUSABLE if error else Verdict.PASS if passed else Verdict.FAIL,
            gear_ratio=str(self._gear.gear_ratio),
            error=error,
            messages=rotor.messages + sum(topic.messages for topic in topics),
            rotor=rotor,
            topics=topics,
            findings=(*self._findings, *self._diagnoses(), *(found.text for found in judgements)),
            series=self._series.series(),
            mechanism=self._gear if isinstance(self._gear, Mechanism) else None,
            module=self._parameters['module'],
        )

    @np.errstate(all='ignore')
    def _take(self, batch: _Batch) -> None:
        there = any(messages.data for messages in batch)
        if self._prefix_open and there:
            self._settle_prefix(batch)
        if self._offset_open and there:
            self._settle_offset(batch)
        rotor, *recorded = batch[: 1 + len(self._outputs)]
        for topic, messages in zip(self._topics, (rotor, *recorded), strict=False):
            if messages.received:
                self._begun.setdefault(topic, messages.received[0])
        if len(self._begun) > len(self._outputs):
            self._absences.begin(max(self._begun.values()))
        self._add_samples(rotor)
        for output, messages in zip(self._outputs, recorded, strict=True):
            output.take(messages.data, messages.received, self._window, self._inputs)
        poses = self.poses.compared if self.poses else {}
        self._series.update(self.output.compared, poses)
        for check in self._checks:
            check.update(self.output.compared, poses)
        done = np.all([output.matcher.matched for output in self._outputs], axis=0)
        settled = len(done) if done.all() else int(np.argmin(done))
        self._drop(max(settled, len(done) - WINDOW))

    def _add_samples(self, messages: TopicMessages) -> None:
        """Add the rotor's samples to the window."""
        samples = self._input.accept_batch(messages.data, messages.received)
        self._inputs.update(samples.received, samples.stamp, samples.rejected)
        self._health.update(samples.stamp, TURN * samples.turns + samples.angle)
        self._window.append(
            stamp=samples.stamp,
            received=samples.received,
            turns=samples.turns,
            angle=samples.angle,
            velocity=samples.velocity,
            effort=samples.effort,
            stretch=samples.stretch,
        )
        for output in self._outputs:
            output.matcher.extend(len(samples.stamp))

    def _drop(self, count: int) -> None:
        oldest = self._window.rows(slice(count))
        matchers = [output.matcher for output in self._outputs]
        answered = np.column_stack([matcher.matched[:count] for matcher in matchers])
        self._absences.update(Inputs(oldest['received'], oldest['stamp'], answered))
        for matcher in matchers:
            matcher.drop(count)
        self._window.drop(count)

    def _close(self) -> None:
        """Count waiting samples and messages as missing and extra, at the end."""
        for _ in range(2):  # late messages wait for one more batch
            self._take(_empty_batch())
        self._drop(len(self._window))
        self._absences.close()

    def _settle_prefix(self, batch: _Batch) -> None:
        """Adopt the frame prefix of the first output, if any."""
        joint = self._parameters['output_joint']
        _, output, poses = batch
        for (data, *_), layout_of, name in (
            (poses.data or [b''], pose_array_layout, _FRAME),
            (output.data or [b''], joint_state_layout, joint),
        ):
            with suppress(MalformedMessageError):
                recorded = layout_of(data).texts[-1].decode(errors='replace')
                if not recorded.endswith(name):
                    continue
                self._prefix_open = False
                if prefix := recorded.removesuffix(name):
                    self._parameters['frame_prefix'] = prefix
                    self.output.joint = prefix + joint
                    if self.poses:
                        self.poses.frame_id = prefix + _FRAME
                    self._findings.append(f'frame_prefix {prefix!r} is taken from the outputs')
                return

    def _settle_offset(self, batch: _Batch) -> None:
        """Determine the offset to accept, if any, from the first batch with outputs.

        Homing moves the rotor's zero and therefore the poses; if there are some, and they agree
        better without that, only the output angle has an offset.
        """
        trial = self._trial(batch, {})
        if not trial.output.fit.count:
            return
        self._offset_open = False
        offset = trial.output.fit.offset(self._tolerances.angle)
        if offset is None:
            return
        direction, zero = self._parameters['rotor_direction'], self._parameters['rotor_zero']
        moved = {'rotor_zero': zero - direction * self._gear.gear_ratio.rotor_angle(offset)}
        if abs(moved['rotor_zero']) > LARGEST_ANGLE:  # garbage, not homing
            return
        if self._trial(batch, moved).worst_position <= trial.worst_position:
            self._input.settings = replace(self._input.settings, **moved)
        else:
            self.output.offset = offset
        self._findings.append(
            f'accepted: the recorded output angle is off by a constant {offset:.12g} rad'
        )

    @property
    def worst_position(self) -> float:
        """The greatest error of a body's position, m; 0 without poses."""
        return self.poses.worst_error if self.poses else 0.0

    def _trial(self, batch: _Batch, changes: Mapping[str, Any]) -> 'Validator':
        trial = Validator(
            {**self._parameters, **changes},
            topics=self._topics,
            tolerances=self._tolerances,
            solver=self._solver,
            strict=self._strict,
        )
        trial._take(batch)
        return trial

    def _diagnoses(self) -> Iterable[str]:
        if not self.output.position.passed:
            found = diagnose(self._gear, self.output.fit, self._tolerances.angle)
            if found:
                yield found
        if self.poses:
            yield from self.poses.findings()
        if self._unseen:
            yield from self._unseen.findings()
        for topic, missing in zip(self._topics[1:], self._absences.topics, strict=False):
            if missing.ended_early is not None:
                yield (
                    f'{topic} ends {missing.ended_early:.3f} s before {self._topics.rotor}: '
                    'the node may have ended'
                )


def _empty_batch() -> _Batch:
    return tuple(TopicMessages() for _ in Topics._fields)
