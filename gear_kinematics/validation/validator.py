"""Compares the outputs of a node with recomputed ones, in one pass over a recording."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import Message, ReportProgress, TopicMessages, in_batches, sort_by_topic
from gear_kinematics.bag.roles import Topics
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import Mechanism, solve
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.validation import checks
from gear_kinematics.validation.corrected_topics import (
    CORRECTED,
    CorrectedTopic,
    RecomputedCorrection,
    why_unjudged,
)
from gear_kinematics.validation.diagnosis import UnseenTurns, diagnose
from gear_kinematics.validation.input_health import InputHealth
from gear_kinematics.validation.lanes import lanes
from gear_kinematics.validation.matching import WINDOW, Group, OutputTopic, Window
from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.output_topics import BodyPoses, OutputState, Solver, Tolerances
from gear_kinematics.validation.recorder import Completeness, Inputs, Missing, RecordedInputs
from gear_kinematics.validation.report import BagReport
from gear_kinematics.wire.cdr import MalformedMessageError, joint_state_layout, pose_array_layout

Array = NDArray[Any]

_FRAME = 'stator'
_TOPICS, _TOLERANCES = Topics(), Tolerances()
_Batch = tuple[TopicMessages, ...]
"""Messages in the order of `Topics`, then those of the corrected output."""


class Validator:
    """Recomputes the outputs from the rotor topic and compares them with the recorded ones."""

    def __init__(
        self,
        parameters: NodeParameters,
        *,
        topics: Topics = _TOPICS,
        tolerances: Tolerances = _TOLERANCES,
        allow_offset: bool = False,
        strict: bool = False,
        solver: Solver = solve,
        calibration: Calibration | None = None,
        corrected: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        """Prepare for a recording.

        Args:
            parameters: of the node.
            topics: names of the topics; that of poses that are not recorded is empty.
            tolerances: greatest accepted errors.
            allow_offset: whether to accept a constant offset of the output angle, as after homing.
            strict: whether to judge all missing and extra messages, even if the recorder may have
                caused them; see `recorder`.
            solver: recomputes the motion: `solve`, or that of the matrix method.
            calibration: of the node; without it, the corrected output is not judged.
            corrected: the recorded ones of CORRECTED_TOPICS, each with its name in the recording.

        Raises:
            ValueError: if the parameters describe no gear.
        """
        self._parameters = parameters
        self._prefix_open = not parameters.frame_prefix
        self._topics = topics
        self._names = *topics, *corrected.values()
        self._tolerances = tolerances
        self._offset_open = allow_offset
        self._solver = solver
        self._strict = strict
        self._gear = gear = parameters.gear
        self._input = RotorInput(parameters)
        self._health = InputHealth(parameters.max_rotor_speed)
        self._rejected = Occurrences()
        self._window = Window()
        self._inputs = RecordedInputs(strict=strict)
        self._begun: dict[str, int] = {}  # when the first message of each topic was received, ns
        single_turn = parameters.single_turn
        self._unseen = UnseenTurns(gear.gear_ratio, tolerances.angle) if single_turn else None
        prefix = parameters.frame_prefix
        common = tolerances, solver, self._unseen
        joint = prefix + parameters.output_joint
        self.output = OutputState(joint, gear, *common)
        self.poses = None
        outputs: tuple[OutputTopic, ...] = (self.output,)
        if isinstance(gear, Mechanism) and topics.poses:
            self.poses = BodyPoses(prefix + _FRAME, gear, *common)
            outputs = self.output, self.poses
        names = topics[: 1 + len(outputs)]
        self._groups = [Group(names, outputs, Completeness(len(outputs), strict=strict))]
        self._unjudged = 0  # messages of the corrected output
        self._why_unjudged = why_unjudged(calibration, single_turn=single_turn)
        self._correction = None
        if calibration and corrected and not self._why_unjudged:
            self._correction = RecomputedCorrection(calibration)
            for topic, name in corrected.items():
                output = CORRECTED[topic](joint, gear, *common)
                absences = Completeness(1, strict=strict)
                self._groups.append(Group((topics.rotor, name), (output,), absences))
        self._findings: list[str] = []
        self._checks = [make(parameters) for make in checks.CHECKS]

    def feed(
        self,
        messages: Iterable[Message],
        progress: ReportProgress | None = None,
        total: int | None = None,
    ) -> None:
        """Process messages on the topics, up to an exception of the iterable, if any.

        Args:
            messages: in the order of their reception.
            progress: called after each batch.
            total: number of the messages, if known.
        """
        for recorded in in_batches(messages, progress=progress, total=total):
            batch = self._empty_batch()
            sort_by_topic(recorded, dict(zip(self._names, batch, strict=True)))
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
        start = rotor.first_stamp or 0
        topics = tuple(
            output.report(name, missing)
            for name, output, missing in self._judged()
            # Without a calibration, the node publishes nothing on the topics of the correction.
            if output.matcher.messages or name in self._topics
        )
        if error is None and not rotor.valid:
            error = f'no usable rotor states: {self._input.why_rejected or "no messages"}'
        elif error is None and not any(topic.messages for topic in topics):
            error = 'no outputs in it'
        judgements = [found for check in self._checks for found in check.judge(rotor)]
        failed = [judgement.text for judgement in judgements if judgement.fails]
        passed = all(topic.passed for topic in topics) and not failed
        causes, notes = tuple(self._causes()), tuple(self._notes())
        inputs = self._topics.rotor, self._health.gaps, self._rejected
        series = (output.series.series(name, start) for name, output, _ in self._judged())
        return BagReport(
            bag=bag,
            verdict=Verdict.UNUSABLE if error else Verdict.PASS if passed else Verdict.FAIL,
            gear_ratio=str(self._gear.gear_ratio),
            error=error,
            messages=rotor.messages + sum(topic.messages for topic in topics),
            rotor=rotor,
            topics=topics,
            findings=(*self._findings, *causes, *notes, *(found.text for found in judgements)),
            causes=(*failed, *causes),
            series=tuple(found for found in series if found),
            lanes=tuple(lanes(inputs, self._judged(), rotor.first_stamp)),
            mechanism=self._gear if isinstance(self._gear, Mechanism) else None,
            module=self._parameters.module,
        )

    @np.errstate(all='ignore')
    def _take(self, batch: _Batch) -> None:
        there = any(messages.data for messages in batch)
        if self._prefix_open and there:
            self._settle_prefix(batch)
        if self._offset_open and there:
            self._settle_offset(batch)
        recorded = dict(zip(self._names, batch, strict=False))
        for topic, messages in recorded.items():
            if messages.received:
                self._begun.setdefault(topic, messages.received[0])
        for names, _, absences in self._groups:
            if self._begun.keys() >= set(names):
                absences.begin(max(self._begun[name] for name in names))
        self._add_samples(recorded[self._topics.rotor])
        for name, output, _ in self._judged():
            messages = recorded[name]
            output.take(messages.data, messages.received, self._window, self._inputs)
        if not self._correction:
            self._unjudged += sum(len(messages.data) for messages in batch[len(self._topics) :])
        poses = self.poses.compared if self.poses else {}
        for check in self._checks:
            check.update(self.output.compared, poses)
        done = np.all([output.matcher.matched for _, output, _ in self._judged()], axis=0)
        settled = len(done) if done.all() else int(np.argmin(done))
        self._drop(max(settled, len(done) - WINDOW))

    def _add_samples(self, messages: TopicMessages) -> None:
        """Add the rotor's samples to the window."""
        samples = self._input.accept_batch(messages.data, messages.received)
        self._inputs.update(samples.received, samples.stamp, samples.rejected)
        self._rejected.add(samples.rejected)
        self._health.update(samples.stamp, TURN * samples.turns + samples.angle)
        self._window.append(
            stamp=samples.stamp,
            received=samples.received,
            turns=samples.turns,
            angle=samples.angle,
            velocity=samples.velocity,
            effort=samples.effort,
            stretch=samples.segment,
            **(self._correction.columns(samples) if self._correction else {}),
        )
        for _, output, _ in self._judged():
            output.matcher.extend(len(samples.stamp))

    def _drop(self, count: int) -> None:
        oldest = self._window.rows(slice(count))
        for _, outputs, absences in self._groups:
            answered = np.column_stack([output.matcher.matched[:count] for output in outputs])
            absences.update(Inputs(oldest['received'], oldest['stamp'], answered))
        for _, output, _ in self._judged():
            output.matcher.drop(count)
        self._window.drop(count)

    def _close(self) -> None:
        """Count waiting samples and messages as missing and extra, at the end."""
        for _ in range(2):  # late messages wait for one more batch
            self._take(self._empty_batch())
        self._drop(len(self._window))
        for group in self._groups:
            group.absences.close()

    def _settle_prefix(self, batch: _Batch) -> None:
        """Adopt the frame prefix of the first output, if any."""
        joint = self._parameters.output_joint
        _, output, poses, *_ = batch
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
                    self._parameters = replace(self._parameters, frame_prefix=prefix)
                    if self.poses:
                        self.poses.frame_id = prefix + _FRAME
                    for topic in self._of_joint():
                        topic.joint = prefix + joint
                    self._findings.append(f'frame_prefix {prefix!r} is taken from the outputs')
                return

    def _settle_offset(self, batch: _Batch) -> None:
        """Determine the offset to accept, if any, from the first batch with outputs.

        Homing moves the rotor's zero and therefore the poses; if there are some, and they agree
        better without that, only the output angle has an offset.
        """
        trial = self._trial(batch, self._parameters)
        if not trial.output.fit.count:
            return
        self._offset_open = False
        offset = trial.output.fit.offset(self._tolerances.angle)
        if offset is None:
            return
        direction, zero = self._parameters.rotor_direction, self._parameters.rotor_zero
        zero -= direction * self._gear.gear_ratio.rotor_angle(offset)
        moved = replace(self._parameters, rotor_zero=zero)
        if abs(zero) > LARGEST_ANGLE:  # garbage, not homing
            return
        if self._trial(batch, moved).worst_position <= trial.worst_position:
            self._input.parameters = moved
        else:
            for topic in self._of_joint():
                topic.offset = offset
        self._findings.append(
            f'accepted: the recorded output angle is off by a constant {offset:.12g} rad'
        )

    @property
    def judges_correction(self) -> bool:
        """Whether there were messages of the corrected output that are judged."""
        return any(
            isinstance(output, CorrectedTopic) and output.matcher.messages > 0
            for _, output, _ in self._judged()
        )

    @property
    def worst_position(self) -> float:
        """The greatest error of a body's position, m; 0 without poses."""
        return self.poses.worst_error if self.poses else 0.0

    def _trial(self, batch: _Batch, parameters: NodeParameters) -> 'Validator':
        trial = Validator(
            parameters,
            topics=self._topics,
            tolerances=self._tolerances,
            solver=self._solver,
            strict=self._strict,
        )
        trial._take(batch[: len(self._topics)])
        return trial

    def _of_joint(self) -> Iterator[OutputState | CorrectedTopic]:
        for _, output, _ in self._judged():
            if isinstance(output, (OutputState, CorrectedTopic)):
                yield output

    def _judged(self) -> Iterator[tuple[str, OutputTopic, Missing]]:
        """Yield name, comparison and missing messages of each output."""
        for (_, *names), outputs, absences in self._groups:
            yield from zip(names, outputs, absences.topics, strict=True)

    def _empty_batch(self) -> _Batch:
        return tuple(TopicMessages() for _ in self._names)

    def _causes(self) -> Iterator[str]:
        """Yield what explains the errors and the missing messages."""
        if not self.output.position.passed:
            found = diagnose(self._gear, self.output.fit, self._tolerances.angle)
            if found:
                yield found
        else:
            yield from self.output.factors()
        if self.poses:
            yield from self.poses.order()
        if self._input.mostly_rejected and self._input.missing_joint:
            yield f'{self._topics.rotor}: {self._input.missing_joint}'
        for group in self._groups:
            yield from group.why_missing()

    def _notes(self) -> Iterator[str]:
        """Yield what fails nothing."""
        if self.poses:
            yield from self.poses.turned_round()
        if self._unseen:
            yield from self._unseen.findings()
        if self._unjudged:
            yield f'the corrected output is not judged: {self._why_unjudged}'
