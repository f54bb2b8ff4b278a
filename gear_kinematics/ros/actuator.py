# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""An actuator of the node: its state, and its shaft."""

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.homing import Shaft
from gear_kinematics.state.gear_state import GearState, RotorAnswer
from gear_kinematics.state.loads import PreloadMonitor


class Actuator:
    """The state of an actuator, which is reported, and where its shaft is."""

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        """Start without messages."""
        self.state = GearState(parameters, calibration)
        if parameters.preload:
            self.state.preload_monitor = PreloadMonitor(parameters)
        self.shaft = Shaft(self.state.input, self.state.monitor)
        self.referenced: bool | None = None
        """Whether the turns are known, as it was published last."""

    def note(self, answer: RotorAnswer, now: float) -> None:
        """Take note of a valid message of the rotor, which came now."""
        self.state.monitor.last_input = now
        self.shaft.note(answer.sample, answer.segment, now)
