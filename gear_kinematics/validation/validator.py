# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the outputs of a node with recomputed ones, in one pass over a recording."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from gear_kinematics.bag import MessagesByTopic
from gear_kinematics.bag.roles import Topics
from gear_kinematics.correction.corrector import Correction
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.loads import LoadEstimator
from gear_kinematics.state.turn_reference import farthest_outside
from gear_kinematics.validation import input_health
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.corrected_topics import CORRECTED, Unbroken, why_unjudged
from gear_kinematics.validation.count_changes import CountChanges, first_number
from gear_kinematics.validation.encoder_errors import EncoderErrors
from gear_kinematics.validation.fields import Array, Window
from gear_kinematics.validation.independent import Independent, IndependentReport
from gear_kinematics.validation.load_topics import LoadTopic
from gear_kinematics.validation.matching import SAMPLES, WINDOW, Expectation, OutputTopic
from gear_kinematics.validation.output_topics import BodyPoses, MechanismStates, OutputState
from gear_kinematics.validation.recorder import Completeness, RecordedInputs
from gear_kinematics.validation.report import BagReport, Finding
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.turn_references import TurnReferences
from gear_kinematics.wire.cdr import MalformedMessageError
from gear_kinematics.wire.topics import JOINT_STATES, LOAD_TOPICS, TRANSMISSION_ERROR

_FRAME = 'stator'
_TOPICS = Topics()
_DOUBTS = {FindingCause.REPEATED_STAMPS, FindingCause.SHORT_SECONDS, FindingCause.JUMPED}
_OF_COUNTS = {FindingCause.BEYOND_LIMITS}  # doubts of missing or additional outputs alone
_NONE: Mapping[str, str] = MappingProxyType({})


class Validator:
    """Recomputes the outputs from the rotor topic and compares them with the recorded ones."""

    def __init__(
        self,
        task: Task,
        topics: Topics = _TOPICS,
        further: Mapping[str, str] = _NONE,
        encoder: str = '',
    ) -> None:
        """Prepare for a recording; raises ValueError if the parameters describe no gear.

        `further` has other recorded topics by their keys in TOPICS, and `encoder` is the topic of
        an encoder at the output, if recorded. Names of other topics that are not recorded are
        empty.
        """
        self.task = task
        self._parameters = parameters = task.parameters
        self.given = topics
        """Names of the topics of the rotor, the output and the poses; '' if not recorded."""
        self.further, self._encoder = further, encoder
        self.topics = {*topics, *further.values(), encoder} - {''}
        """Names of all topics that may be in the messages."""
        self._corrected = [name for topic, name in further.items() if topic in CORRECTED]
        self._gear = gear = parameters.gear
        self._state = GearState(parameters, task.calibration)
        self._health = input_health.InputHealth(parameters.max_rotor_speed)
        self._inputs = RecordedInputs(strict=task.strict)
        self._begun: dict[str, int] = {}  # when the first message of each topic was received, ns
        angle, homing = task.tolerances.angle, not task.strict
        self._changes = CountChanges(parameters, angle, homing=homing)
        self._expectation = Expectation(gear, task.tolerances, self._changes)
        self._samples = 0
        self._unseen = bool(parameters.rotor_period) or parameters.absolute
        """Whether the turns can change unseen, so that they are known from outputs alone."""
        self._given_segment = None if self._unseen else self._state.input.segment
        """The latest segment with an output."""
        joint = parameters.output_name
        self.output = OutputState(topics.output, joint, self._expectation)
        self.poses = None
        if isinstance(gear, Mechanism) and topics.poses:
            frame = parameters.frame_prefix + _FRAME
            self.poses = BodyPoses(topics.poses, frame, gear, self._expectation)
        self.unjudged = '' if self.poses else topics.poses
        """The topic of the poses, if they are recorded and the gear has no bodies."""
        self._why_unjudged = why_unjudged(task.calibration, parameters)
        errors = further.get(TRANSMISSION_ERROR)
        self.errors = EncoderErrors(errors, parameters, angle) if encoder and errors else None
        """Judge of transmission errors, if they and the encoder are recorded."""
        self._references = TurnReferences(self._state) if parameters.absolute else None
        """Judge of the turns by the encoder at the output, if that determines them."""
        self._unbroken, self._corrector, self._loads = Unbroken(), None, None
        columns: list[Any] = list(SAMPLES)
        if self._corrected and not self._why_unjudged:
            self._corrector = self._state.corrector
            columns += [(name, np.float64) for name in Correction._fields]
        groups: list[list[OutputTopic]] = [[*filter(None, (self.output, self.poses))]]
        for topic, name in further.items():
            if topic in LOAD_TOPICS:
                self._loads = self._loads or LoadEstimator(parameters)
                groups.append([LoadTopic(topic, name, self._loads, self._expectation)])
            elif topic == JOINT_STATES and isinstance(gear, Mechanism):
                names = parameters.joint_names
                groups.append([MechanismStates(name, names, gear, self._expectation)])
            elif self._corrector and topic in CORRECTED:
                groups.append([CORRECTED[topic](name, joint, self._expectation)])
        self._groups = []
        """Outputs that are recorded from the same time on: a node publishes the first ones all."""
        for of in groups:
            missing = {output.name: output.missing for output in of}
            self._groups.append((Completeness(topics.rotor, missing, strict=task.strict), of))
        for output in self.outputs:
            output.shared = bool(parameters.actuator)
        joint_states = further.get(JOINT_STATES, '')
        self._proof = Independent(task, topics, joint_states) if task.independent else None
        if self._loads:
            columns.append(('acceleration', np.float64))
        self._window = Window({name: np.zeros(0, kind) for name, kind in columns})
        """The latest samples."""
        self._prefix_open = not (parameters.frame_prefix or parameters.actuator)
        self._findings: list[Finding] = []

    @np.errstate(all='ignore')  # recorded numbers are arbitrary; overflows fail
    def report(
        self, error: str | None = None, lost: Mapping[str, int] = MappingProxyType({})
    ) -> BagReport:
        """Return the report on all messages; to be called once, at the end.

        `error` is the damage at which reading ended. `lost` counts by topic the messages that the
        recorder lost, according to itself.
        """
        if any(output.late for output in self.outputs):  # they wait for one more batch
            self.take(MessagesByTopic(self.topics))
        self._drop(len(self._window))
        contradict = self._state.input.velocity_field.contradicts
        self.output.judge_velocities(contradict=contradict)
        for group, _ in self._groups:
            group.close(lost)
        if self._changes.homed:  # the correction does not take it into account
            why = 'the zero of the rotor changes during the recording'
            self._corrector, self._why_unjudged = None, self._why_unjudged or why
        unjudged = () if self._corrector else self._corrected
        judged = {*self.given, *self.further.values()}.difference(unjudged)
        rotor = self._health.report(self._state.input, self.given.rotor)
        topics = tuple(
            output.report()
            for output in self.outputs
            # Without a calibration, the node publishes nothing on the topics of the correction.
            if (output.matcher.messages or output.name in self.given) and output.name in judged
        )
        if error is None and not rotor.valid:
            error = f'no usable rotor states: {self._state.input.why_rejected or "no messages"}'
        elif error is None and not any(topic.messages for topic in topics):
            error = self.output.why_none(self._parameters, self._begun)
        checked = [finding for check in input_health.CHECKS for finding in check(rotor)]
        proof = self._proof.report() if self._proof and error is None else None
        findings = *self._found(proof), *checked
        passed = not any(finding.fails for finding in findings) and all(t.passed for t in topics)
        if not passed:
            known = _DOUBTS if any(t.wrong or t.faults for t in topics) else _DOUBTS | _OF_COUNTS
            doubts = [replace(each, explains=True) for each in findings if each.cause in known]
            findings = *doubts, *(each for each in findings if each.cause not in known)
        start = rotor.first_stamp or 0
        series = (output.series.series(output.name, start) for output in self.outputs)
        return BagReport(
            bag=str(self.task.bag),
            verdict=Verdict.UNUSABLE if error else Verdict.PASS if passed else Verdict.FAIL,
            config=self.task.config,
            gear_ratio=str(self._gear.gear_ratio),
            error=error,
            messages=rotor.messages + sum(topic.messages for topic in topics),
            rotor=rotor,
            topics=topics,
            findings=findings,
            independent=proof,
            series=tuple(found for found in series if found),
            mechanism=self._gear if isinstance(self._gear, Mechanism) else None,
            module=self._parameters.module,
        )

    @property
    def outputs(self) -> list[OutputTopic]:
        """The output topics that are compared."""
        return [output for _, outputs in self._groups for output in outputs]

    @np.errstate(all='ignore')
    def take(self, batch: MessagesByTopic) -> None:
        """Process messages on the topics, and perhaps on others."""
        if self._proof:
            self._proof.take(batch)
        if self._prefix_open and any(messages.data for messages in batch.values()):
            self._find_prefix(batch)
        for topic in self.topics:
            if len(received := batch[topic].received):
                self._begun.setdefault(topic, received[0])
        segments = self._add_samples(batch)
        self.output.unstamped = bool(self._state.input.zero_stamps)
        for output in self.outputs:
            messages = batch[output.name]
            output.take(messages.data, messages.received, self._window, self._inputs)
            if output is self.output:
                self._window['turns_known'] |= output.matcher.matched
                self._correct(segments)
        done = np.all([output.answered(self._window) for output in self.outputs], axis=0)
        answered = len(done) if done.all() else int(np.argmin(done))
        self._drop(max(answered, len(done) - WINDOW))

    def _add_samples(self, batch: MessagesByTopic) -> Array:
        """Add the rotor's samples to the window, and return their unbroken segments, (n,)."""
        messages = batch[self.given.rotor]
        field = self._state.input.effort_field
        was_real = field.real
        self.samples = samples = self._state.input.accept_batch(messages.data, messages.received)
        self._inputs.update(samples.received, samples.stamp, samples.rejected)
        self._health.update(samples)
        columns = {name: getattr(samples, name) for name, _ in SAMPLES[4:]}
        columns['number'] = first_number(samples.segment) + self._samples
        columns['number'] += np.arange(len(samples.stamp))
        columns['turns_known'] = np.full(len(samples.stamp), not self._unseen)
        decided = self._state.input.velocity_field.decided
        columns['velocity_open'] = samples.stamp <= (np.inf if decided is None else decided)
        real = (samples.effort != 0.0) & ~np.isnan(samples.effort)
        zeros = field.zeros and not was_real
        columns['effort_open'] = zeros & ~np.logical_or.accumulate(real)
        self._samples += len(samples.stamp)
        segments = samples.segment
        if self._loads or self._corrector:
            segments = self._unbroken.segments(samples.stamp, samples.segment)
        if self._loads:
            found = self._loads.accelerations(samples.stamp, samples.velocity, segments)
            columns['acceleration'] = np.where(np.isnan(samples.effort), np.nan, found)
        if self._corrector:  # those that `_correct` fills in
            columns |= {name: np.zeros(len(samples.stamp)) for name in Correction._fields}
        new = Window(columns)
        if self._references and self._encoder:
            self._references.take_encoder(batch[self._encoder])
        if self.errors:
            self.errors.take(batch[self._encoder], batch[self.errors.name])
        self._window = self._window.extended(new)
        for output in self.outputs:
            output.matcher.extend(len(new))
        return segments

    def _correct(self, segments: Array) -> None:
        """Add the correction to the latest samples, whose turns are known from the outputs."""
        if self._corrector and len(segments):
            latest = self._window.take(slice(-len(segments), None))
            self._changes.move(latest)
            # After a change, the state of play is unknown.
            latest['segment'] = segments + self._changes.count
            names = 'stamp', 'turns', 'angle', 'velocity', 'effort', 'segment'
            found = self._corrector.correct_batch(
                *(latest[name] for name in names), referenced=latest['referenced']
            )
            for name, values in found._asdict().items():
                self._window[name][-len(segments) :] = values

    def _drop(self, count: int) -> None:
        """Drop the oldest samples, which have their outputs or whose outputs count as missing."""
        oldest = self._window.take(slice(count))
        withheld = self._withheld(oldest)
        for group, outputs in self._groups:
            answered = np.array([output.answered(oldest) for output in outputs]) | withheld
            group.update(oldest['received'], oldest['stamp'], answered, self._begun)
        moved = Window(oldest.columns)
        self._changes.move(moved)
        self._health.outside = self._health.outside or farthest_outside(
            self._parameters, moved['turns'], moved['angle'], moved['referenced']
        )
        if self._references and self._encoder:
            self._references.take_rotor(moved)
        if self.errors:
            self.errors.take_rotor(oldest, moved, self.output.answered(oldest))
        for output in self.outputs:
            output.matcher.drop(count)
        self._window = self._window.take(slice(count, None))

    def _withheld(self, samples: Window) -> Array:
        """Return for which samples, (n,), the node may have withheld outputs of unknown turns.

        Where in a segment its outputs begin, a recording of the rotor does not show.
        """
        withheld = np.zeros(len(samples), bool)
        if self._parameters.unreferenced_outputs == 'withhold':
            given = self.output.answered(samples)
            for segment in np.unique(samples['segment']).tolist():
                rows = np.flatnonzero(samples['segment'] == segment)
                if segment != self._given_segment:
                    none = ~np.logical_or.accumulate(given[rows])
                    withheld[rows] = none
                    if not none.all():
                        self._given_segment = segment
        return withheld

    def _find_prefix(self, batch: MessagesByTopic) -> None:
        """Adopt the frame prefix of the first output, if any."""
        for output in filter(None, (self.poses, self.output)):
            with suppress(MalformedMessageError, IndexError):
                first = batch[output.name].data[0]
                label = output.layout(first).texts[-1].decode(errors='replace')
                if label.endswith(output.label):
                    self._prefix_open = False
                    if prefix := label.removesuffix(output.label):
                        self._parameters = replace(self._parameters, frame_prefix=prefix)
                        for each in self.outputs:
                            each.label = prefix + each.label
                        taken = Finding(FindingCause.PREFIX_TAKEN, values={'prefix': prefix})
                        self._findings.append(taken)
                    return

    def _found(self, proof: IndependentReport | None) -> Iterator[Finding]:
        """Yield what the outputs are compared with, what explains their faults, and the rest."""
        if self.unjudged:
            yield Finding(FindingCause.POSES_UNJUDGED, values={'poses': self.unjudged})
        elif isinstance(self._gear, Mechanism) and self.outputs == [self.output]:
            yield Finding(FindingCause.NO_POSES, values={'output': self.output.name})
        yield from self._findings
        yield from self._changes.notes()
        if self._references:
            yield self._references.finding()
        if self.errors:
            yield from self.errors.findings()
        for output in self.outputs:
            yield from output.causes()
        if self._state.input.mostly_rejected and self._state.input.missing_joint:
            values = {'topic': self.given.rotor, 'detail': self._state.input.missing_joint}
            yield Finding(FindingCause.JOINT_MISSING, values=values, explains=True)
        for group, _ in self._groups:
            yield from group.causes()
        if not self._corrector and self._begun.keys() & set(self._corrected):
            yield Finding(FindingCause.CORRECTION_UNJUDGED, values={'why': self._why_unjudged})
        if proof:
            cause, of = FindingCause.INDEPENDENT, {'independent': proof}
            yield Finding(cause, '', proof.first_wrong, values=of, fails=not proof.passed)
