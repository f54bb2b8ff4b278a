# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The log of the rotor's driver: that it is missing, has stopped, or has returned."""

import math

from rclpy.node import Node

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.ros.graph import Graph
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.nearest import listed
from gear_kinematics.wire.topics import ROTOR_STATE

_ELSEWHERE = 0.1  # rad, of a rotor that was turned by hand, or counted from another zero
_HOME = 'check whether the drive restarted; then call ~/home'


class DriverLog:
    """Logs each change once."""

    def __init__(self, node: Node, rotor_input: RotorInput) -> None:
        """Start with the node that subscribes to the rotor's topic."""
        self._log, self._node, self._input = node.get_logger(), node, rotor_input
        self._topic = node.resolve_topic_name(ROTOR_STATE)
        self._looked = False
        """Whether there was no publisher at the last update either."""
        self._jumps = rotor_input.plausibility.jumps
        self._before: RotorSample | None = None  # the silence
        self.awaited = False
        """Whether it was logged that the driver is missing or silent."""

    def update(self, publishers: int, silence: float) -> None:
        """Take the number of publishers, and the time since the last message, s, if any.

        This is to be called once a second.
        """
        plausibility, last = self._input.plausibility, self._input.last
        if plausibility.jumps > self._jumps:
            self._log.warning(f'{plausibility.jumped}: {_HOME}')
        self._jumps = plausibility.jumps
        looked, self._looked = self._looked, not publishers
        if self.awaited:
            return
        if last and silence > self._input.parameters.input_timeout:
            self._log.warning(f'{self._topic} has stopped: no input for {silence:.1f} s')
            self.awaited, self._before = True, last
        # At the first update, not all publishers are discovered yet.
        elif not (publishers or last) and looked and (others := Graph(self._node).drivers()):
            self._log.warning(
                f'{self._topic} has no publisher; there are: {listed(others)}; choose one with '
                f'-r {ROTOR_STATE}:=<topic>, or with ros2 launch {ROTOR_STATE}:=<topic>'
            )
            self.awaited = True

    def heard(self, sample: RotorSample) -> None:
        """Take the first sample while the driver was awaited."""
        self.awaited, before, self._before = False, self._before, None
        moved = sample.position.since((before or sample).position)
        if abs(moved) > _ELSEWHERE:
            self._jumps = self._input.plausibility.jumps
            at = f'the rotor is {math.degrees(moved):.0f}° from where it was'
            self._log.warning(f'{self._topic} is heard again, but {at}: {_HOME}')
        else:
            self._log.info(f'{self._topic} is heard now')
