# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the node makes of recorded messages of both encoders, in the order of their arrival."""

from collections.abc import Iterable, Iterator
from functools import partial
from typing import Any

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.correction.corrector import Correction, Corrector
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput, RotorSamples
from gear_kinematics.state.turn_reference import TurnReference
from gear_kinematics.wire.joint_reader import RejectedInputError

Arrival = tuple[bool, int, bytes]
"""Whether a message is the rotor's, when it was received, ns, and its bytes."""


class ReferencedInput:
    """Takes messages one by one, of which those of the output encoder reference the rotor."""

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None = None) -> None:
        self.rotor = RotorInput(parameters)
        self.reference = TurnReference(self.rotor)
        self._encoder = OutputEncoder(parameters, self.reference)
        acceleration = parameters.max_rotor_acceleration
        self._corrector = Corrector(calibration, acceleration) if calibration else None

    def take_batch(self, arrivals: Iterable[Arrival]) -> tuple[RotorSamples, Correction | None]:
        """Return the samples of the next messages, without rejected ones, and the correction."""
        taken = list(self.take(arrivals))
        samples = RotorSamples.of([row for row, _ in taken], np.zeros(0, np.int64))
        if not self._corrector:
            return samples, None
        corrections = np.array([correction for _, correction in taken], float)
        return samples, Correction(*corrections.reshape(-1, len(Correction._fields)).T)

    def take(
        self, arrivals: Iterable[Arrival]
    ) -> Iterator[tuple[tuple[Any, ...], Correction | None]]:
        """Yield the next samples, as rows of `RotorSamples`, with their corrections."""
        rotor, encoder, row = self.rotor, self._encoder, -1
        for of_rotor, received, data in arrivals:
            now = partial(int, received)
            row += of_rotor
            try:
                if not of_rotor:
                    encoder.accept(data, now)
                    continue
                sample = rotor.accept(data, now)
            except RejectedInputError:  # which is counted
                continue
            correction, segment = None, rotor.segment
            if self._corrector:
                known = rotor.referenced
                correction = self._corrector.correct(sample, segment=segment, referenced=known)
            motion = *sample.position, sample.velocity, sample.effort
            yield (sample.stamp, *motion, row, received, segment), correction
            if encoder.received:
                encoder.follow(sample, correction)
