# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges the turns, or the zero, that the output encoder gave a node, by the recorded encoder.

At which sample the rotor's count was referenced is taken from the outputs, as a recorder does not
see the order of arrival in the node. From then on, they have to agree with the encoder.
"""

from collections.abc import Sequence
from contextlib import suppress
from functools import partial

from gear_kinematics.bag import TopicMessages
from gear_kinematics.correction.transmission_error import ErrorBlock, ErrorSample
from gear_kinematics.kinematics import RotorPosition, RotorSample
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.turn_reference import decide
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Window
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.joint_reader import RejectedInputError

_PATIENCE = 3  # blocks in a row that disagree, within which a node must be referenced


class TurnReferences:
    """Decides as the node does, block by block, whether the outputs agree with the encoder."""

    def __init__(self, gear: GearState) -> None:
        """Take the encoder of a gear, which no longer references the turns of that gear."""
        self._parameters, self._corrector = gear.parameters, gear.corrector
        self._encoder = gear.output_encoder
        self._encoder.reference = None
        self._block, self._segment = ErrorBlock(self._parameters), -1
        self._agreed, self._disagreeing = False, 0
        self._fault: Finding | None = None

    def take_encoder(self, messages: TopicMessages) -> None:
        """Process the next messages of the encoder."""
        for received, data in zip(messages.received, messages.data, strict=True):
            with suppress(RejectedInputError):
                self._judge(self._encoder.accept(data, partial(int, received)))

    def take_rotor(self, samples: Window) -> None:
        """Process the next samples, (n,), which are counted as in the outputs."""
        columns = (samples[name].tolist() for name in ('segment', 'stamp', 'turns', 'angle'))
        for segment, stamp, turns, angle in zip(*columns, strict=True):
            if segment != self._segment:
                self._block = ErrorBlock(self._parameters)
                self._segment, self._disagreeing = segment, 0
            sample = RotorSample(stamp, RotorPosition(int(turns), angle), None, None)
            correction = None
            if self._corrector:
                correction = self._corrector.correct(sample, segment=segment, referenced=False)
            self._judge(self._encoder.follow(sample, correction))

    def finding(self) -> Finding:
        """Judge the references."""
        if self._fault:
            return self._fault
        return Finding(
            FindingCause.ENCODER_AGREES if self._agreed else FindingCause.ENCODER_UNKNOWN
        )

    def _judge(self, samples: Sequence[ErrorSample]) -> None:
        for sample in samples:
            if not (errors := self._block.add(sample)):
                continue
            decision = decide(errors, self._parameters)
            fault = (decision.unambiguous or decision.outside) and decision.disagreement
            self._agreed |= decision.unambiguous and not fault
            self._disagreeing = self._disagreeing + 1 if fault else 0
            if fault and self._disagreeing == _PATIENCE and not self._fault:
                self._fault = Finding(
                    FindingCause.ENCODER_DISAGREES,
                    stamp=sample.stamp,
                    values={'disagreement': fault},
                    fails=True,
                )
