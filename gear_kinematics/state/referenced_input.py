# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the node makes of recorded messages of both encoders, in the order of their arrival."""

from collections.abc import Sequence
from contextlib import suppress
from functools import partial

import numpy as np

from gear_kinematics.correction.corrector import Correction, Corrector
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput, RotorSamples
from gear_kinematics.state.turn_reference import TurnReference
from gear_kinematics.wire.joint_reader import RejectedInputError


class ReferencedInput:
    """Takes messages one by one, of which those of the output encoder reference the rotor."""

    def __init__(self, rotor: RotorInput, corrector: Corrector | None) -> None:
        self._rotor, self._corrector = rotor, corrector
        self._encoder = OutputEncoder(rotor.parameters, TurnReference(rotor))

    def take_batch(
        self, messages: Sequence[tuple[str, int, bytes]], rotor_topic: str, encoder_topic: str
    ) -> tuple[RotorSamples, Correction | None]:
        """Return the samples in messages, without rejected ones, and their correction, if any."""
        rotor, encoder, rows, corrections = self._rotor, self._encoder, [], []
        for row, (topic, received, data) in enumerate(messages):
            with suppress(RejectedInputError):  # which is counted
                if topic == encoder_topic:
                    encoder.accept(data, partial(int, received))
                if topic != rotor_topic:
                    continue
                sample = rotor.accept(data, partial(int, received))
                motion = *sample.position, sample.velocity, sample.effort
                rows.append((sample.stamp, *motion, row, received, rotor.segment))
                correction = None
                if self._corrector:
                    correction = self._corrector.correct(
                        sample, segment=rotor.segment, referenced=rotor.referenced
                    )
                    corrections.append(correction)
                if encoder.received:
                    encoder.follow(sample, correction)
        samples = RotorSamples.of(rows, np.zeros(0, np.int64))
        if not self._corrector:
            return samples, None
        columns = np.array(corrections, float).reshape(-1, len(Correction._fields)).T
        return samples, Correction(*columns)
