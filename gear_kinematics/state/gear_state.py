# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One actuator, from its messages to the outputs of the node, without ROS."""

from collections.abc import Callable, Collection, Iterable, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.corrector import Correction, Corrector
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.kinematics import Mechanism, RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import LoadEstimator, PreloadMonitor
from gear_kinematics.state.monitors import Connections, EncoderMonitor, InputMonitor
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.state.state_messages import OutputMessages, Row, state_messages
from gear_kinematics.state.statuses import GearReport
from gear_kinematics.state.turn_reference import TurnReference
from gear_kinematics.wire.joint_reader import JointMessage, RejectedInputError
from gear_kinematics.wire.topics import (
    CORRECTED_TOPICS,
    LOAD_TOPICS,
    OUTPUT_STATE,
    STATE_TOPICS,
    TRANSMISSION_ERROR,
)


class RotorAnswers(NamedTuple):
    """The results of many messages, of which n are valid, as arrays (n,)."""

    samples: RotorSamples
    correction: Correction | None
    errors: Sequence[ErrorSample]  # those that became known with a message of either encoder


class GearState:
    """Follows the messages of one actuator, and computes and encodes what a node publishes.

    Whatever is wrong with a message is decided and counted here, for every program. Messages are
    taken one by one or many at once, with the same results.
    """

    messages: OutputMessages  # encodes the states, once topics are chosen

    # Results of the latest valid message of the rotor; returning a tuple would take longer.
    sample: RotorSample
    segment = -1  # as in `RotorSamples`
    referenced = False  # whether the rotor's turns were known when it came
    withheld = False  # whether they were not, and the parameters withhold outputs of unknown turns
    correction: Correction | None = None  # None without a calibration
    errors: Sequence[ErrorSample] = ()  # the transmission errors that have become known, in order

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None = None) -> None:
        """Start without messages; no topics are chosen."""
        self._chosen: Collection[str] | None = None
        self._loads: LoadEstimator | None = None
        self._configure(parameters, calibration)
        self.input = RotorInput(parameters)
        self.output_encoder = OutputEncoder(parameters, TurnReference(self.input))
        self.monitor = InputMonitor(self.input, self.output_encoder)
        self.encoder_monitor = EncoderMonitor(self.input, self.output_encoder)
        self.preload_monitor: PreloadMonitor | None = None  # if the preload is reported on

    def apply(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        """Change the parameters; all counts go on, and so do turns if their encoders are the same.

        The transmission error and the corrections begin again. Raises ValueError if messages on
        chosen topics cannot have the names in the parameters.
        """
        if not parameters.only_zero_differs(self.parameters):
            self._loads = None
        self.input.parameters = parameters
        self.output_encoder.configure(parameters)
        self._configure(parameters, calibration)
        if self._chosen is not None:
            self.choose(self._chosen)

    def _configure(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        self.parameters, self.calibration = parameters, calibration
        self.corrector = (
            Corrector(calibration, parameters.max_rotor_acceleration) if calibration else None
        )
        self.correction = None
        self._withholding = parameters.unreferenced_outputs == 'withhold'

    @property
    def topics(self) -> Collection[str]:
        """All topics that can be chosen."""
        mechanism = isinstance(self.parameters.gear, Mechanism)
        states, loads = (STATE_TOPICS, LOAD_TOPICS) if mechanism else ((OUTPUT_STATE,), ())
        return *states, *CORRECTED_TOPICS, TRANSMISSION_ERROR, *loads

    def choose(self, topics: Collection[str]) -> None:
        """Encode messages for these of `topics` from now on, and compute what they need.

        Raises ValueError if messages cannot have the names in the parameters, or MechanismError if
        loads are wanted of an impossible preload.
        """
        self._chosen = topics
        self._states = [topic for topic in topics if topic in STATE_TOPICS]
        self._corrections = [topic for topic in topics if topic in CORRECTED_TOPICS]
        self._load_topics = [topic for topic in topics if topic in LOAD_TOPICS]
        self.errors_chosen = TRANSMISSION_ERROR in topics
        self.messages = state_messages(self.parameters)
        if self._load_topics and not self._loads:
            self._loads = LoadEstimator(self.parameters)

    def rotor(self, data: JointMessage, now: Callable[[], int]) -> RotorSample:
        """Process the next message of the rotor; see `RotorInput.accept`."""
        rotor = self.input
        self.sample = sample = rotor.accept(data, now)
        self.segment = segment = rotor.segment
        self.referenced = referenced = rotor.turns.referenced
        self.withheld = self._withholding and not referenced
        if not referenced:
            self.monitor.unreferenced += 1
            self.monitor.withheld += self.withheld
        if self.corrector:  # also without a listener, to follow the motion
            self.correction = self.corrector.correct(
                sample, segment=segment, referenced=referenced
            )
        encoder = self.output_encoder
        compared = encoder.received and (referenced or self.parameters.absolute)
        self.errors = encoder.follow(sample, self.correction) if compared else ()
        if self.preload_monitor:
            self.preload_monitor.follow(sample, segment)
        return sample

    def encoder(self, data: JointMessage, now: Callable[[], int]) -> Sequence[ErrorSample]:
        """Process the next message of the output's encoder; see `OutputEncoder.accept`."""
        return self.output_encoder.accept(data, now, self.input.last)

    def encode(self) -> list[tuple[str, bytes]]:
        """Return topic and message of what is published on the chosen topics for a message."""
        stamp = self.sample.stamp
        encoded = [
            (topic, template.encode(stamp, numbers)) for topic, template, numbers in self.rows()
        ]
        return encoded + self.encode_errors(self.errors) if self.errors else encoded

    def rows(self) -> list[Row]:
        """Return templates and numbers of the messages on the chosen topics, without errors.

        To be called for each message: the loads depend on accelerations, which follow the motion.
        """
        if self.withheld:
            return []
        sample = self.sample
        rows = self.messages.rows(sample, self._states)
        if self.correction:
            rows += self.messages.corrected_rows(sample, self.correction, self._corrections)
        if self._loads and self._load_topics:
            # Another zero changes no acceleration.
            loads = self._loads.follow(sample, self.segment - self.input.rezeroed)
            rows += self._loads.rows(loads, self._load_topics)
        return rows

    def encode_errors(self, errors: Iterable[ErrorSample]) -> list[tuple[str, bytes]]:
        """Return topic and message of transmission errors, if their topic is chosen."""
        encode, chosen = self.messages.angle.encode, self.errors_chosen
        return [(TRANSMISSION_ERROR, encode(e.stamp, [e.error])) for e in errors if chosen]

    def report(self, now: float, connections: Connections) -> dict[str, GearReport]:
        """Report facts by subject since the last report, until a time of a steady clock, s."""
        reports = {'rotor input': self.monitor.report(now, connections)}
        if errors := self.encoder_monitor.report(now, connections.encoder):
            reports['transmission error'] = errors
        if self.preload_monitor:
            reports['preload'] = self.preload_monitor.report()
        return reports

    def batch(
        self, messages: Sequence[tuple[str, int, bytes]], rotor: str, encoder: str = ''
    ) -> RotorAnswers:
        """Process many messages in the order of their reception.

        Those on other topics than the rotor's and the output encoder's are left out. The rows of
        the samples are indices of messages: topic, time of reception, ns, and data.
        """
        correction, errors = None, list[ErrorSample]()
        if self.output_encoder.received or any(topic == encoder for topic, *_ in messages):
            rows, corrections = [], list[Correction]()
            for row, (topic, received, data) in enumerate(messages):
                with suppress(RejectedInputError):  # which is counted
                    if topic == encoder:
                        errors += self.encoder(data, partial(int, received))
                    if topic != rotor:
                        continue
                    sample = self.rotor(data, partial(int, received))
                    rows.append((sample, row, received, self.segment, self.referenced))
                    corrections += [self.correction] if self.correction else []
                    errors += self.errors
            samples = RotorSamples.of(rows)
            self.input.disorder.compare(samples, self.input.turns.max_acceleration)
            self.input.effort_field.note(samples.effort)
            if self.corrector:
                columns = np.array(corrections, float).reshape(-1, len(Correction._fields)).T
                correction = Correction(*columns)
            return RotorAnswers(samples, correction, errors)
        places = [row for row, (topic, *_) in enumerate(messages) if topic == rotor]
        samples = self.input.accept_batch(
            [messages[row][2] for row in places], [messages[row][1] for row in places]
        )
        samples = samples._replace(row=np.array(places, np.int64)[samples.row])
        if self.corrector:
            correction = self.corrector.correct_batch(
                *samples[:5], samples.segment, referenced=samples.referenced
            )
        return RotorAnswers(samples, correction, errors)

    def encode_batch(self, answers: RotorAnswers) -> dict[str, list[bytes]]:
        """Encode the states, all corrections if there are any, and all loads if one is chosen.

        A sample without a message has an empty one. Nothing is withheld.
        """
        samples, correction, _ = answers
        encoded = self.messages.encode_outputs(samples)
        if correction:
            encoded |= self.messages.encode_corrections(samples, correction)
        if self._loads and self._load_topics:
            loads = self._loads.follow_batch(samples)
            encoded |= self._loads.encode_batch(samples.stamp, loads)
        return encoded
