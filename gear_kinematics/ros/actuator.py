# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""An actuator of the node: its state, monitors and reports."""

import time

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.homing import Shaft
from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor, StatusReport
from gear_kinematics.state.gear_state import GearState, RotorAnswer
from gear_kinematics.state.loads import PreloadMonitor


class Actuator:
    """The state of an actuator, and the reports on it."""

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        """Start without messages."""
        self.state = GearState(parameters, calibration)
        self.monitor = InputMonitor(started=time.monotonic())
        self.encoder_monitor = EncoderMonitor()
        self.shaft = Shaft(self.state.input, self.monitor)
        self.referenced: bool | None = None
        """Whether the turns are known, as it was published last."""
        self._preload = PreloadMonitor(parameters) if parameters.preload else None

    def note(self, answer: RotorAnswer, now: float) -> None:
        """Take note of a valid message of the rotor, which came now."""
        self.monitor.last_input = now
        self.shaft.note(answer.sample, answer.segment, now)

    def note_published(self, answer: RotorAnswer) -> None:
        """Take note of the answer to a valid message of the rotor."""
        sample, segment, referenced, withheld, *_ = answer
        self.monitor.published += not withheld
        self.monitor.unreferenced += not referenced
        if self._preload:
            self._preload.follow(sample, segment)

    def reports(self, now: float) -> dict[str, StatusReport | None]:
        """Report by subject on the time since the last report, until now."""
        encoder = self.state.output_encoder
        errors = self.encoder_monitor.report(encoder, self.state.parameters, now)
        received = self.monitor.report(self.state.input, now, encoder.reference)
        preload = self._preload.report() if self._preload else None
        return {'rotor input': received, 'transmission error': errors, 'preload': preload}
