# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The service ~/home, and the zero that is kept in the home file."""

import math
import time
from dataclasses import replace
from pathlib import Path

from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.home_file import read_home, write_home
from gear_kinematics.state.diagnostics import InputMonitor
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND

_SPEED_SPAN = 0.1
"""s between the positions that give a speed, at least: of messages at 1 kHz, one step of an
encoder with 4096 counts per turn would be 1.5 rad/s, and 0.08 rad/s at an output that rests."""


def restored(node: Node, path: Path, parameters: NodeParameters) -> NodeParameters:
    """Set the zero of the home file, if there is one; returns the parameters with it.

    Raises:
        ConfigError: if the file cannot be used.
    """
    if not (home := read_home(path, parameters, node.get_fully_qualified_name())):
        return parameters
    zero, homed = home
    node.set_parameters([Parameter('rotor_zero', value=zero)])
    node.get_logger().info(f'rotor_zero {zero:.3f} rad restored from {path}, homed {homed}')
    return replace(parameters, rotor_zero=zero)


class Homing:
    """Sets the zero of a node on request, and keeps it."""

    def __init__(
        self, node: Node, path: Path | None, rotor_input: RotorInput, monitor: InputMonitor
    ) -> None:
        """Open the service; `path` is that of the home file, if there is to be one."""
        self._node, self._path, self._input, self._monitor = node, path, rotor_input, monitor
        monitor.zero_kept = 'lost at restart: set home_file'
        if path:
            monitor.zero_kept = f'kept in {path}' if path.exists() else 'not kept: not homed yet'
        self._seen = 0.0  # time of the last valid input; s of a steady clock
        self._before: RotorSample | None = None  # where `_speed` was measured
        self._segment = 0  # of that
        self._speed = 0.0  # of the rotor, rad/s
        node.create_service(Trigger, '~/home', self.answer)

    def note(self, sample: RotorSample, segment: int) -> None:
        """Take note of a valid input: where the shaft is, and how fast the rotor turns.

        Without a velocity that is the mean over `_SPEED_SPAN`; 0 until there is one.
        """
        self._seen = time.monotonic()
        if not self._before or self._segment != segment:  # other turns or zero
            self._before, self._segment, self._speed = sample, segment, 0.0
        elapsed = (sample.stamp - self._before.stamp) / SECOND
        if elapsed >= _SPEED_SPAN:
            travel = sample.position.since(self._before.position)
            self._before, self._speed = sample, travel / elapsed
        if sample.velocity is not None:
            self._speed = sample.velocity

    def keep(self) -> None:
        """Write the zero that was set to the home file."""
        if not self._path:
            return
        try:
            write_home(self._path, self._input.parameters, self._node.get_fully_qualified_name())
            self._monitor.zero_kept = f'kept in {self._path}'
        except OSError as error:  # the zero holds until the node ends
            self._monitor.zero_kept = f'not kept: {self._path}: {error.strerror}'

    def answer(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Declare that the output shaft is at `home_angle` now, or tell why not."""
        response.success, response.message = self._home()
        return response

    def _home(self) -> tuple[bool, str]:
        parameters, turns = self._input.parameters, self._input.turns
        ratio, limit = parameters.gear.gear_ratio, parameters.home_max_speed
        rotor_angle = ratio.rotor_angle(parameters.home_angle)
        try:
            zero = self._input.zero_for(rotor_angle)
            before = turns.relative_to(self._input.zero, parameters.rotor_direction)
        except RuntimeError:  # after the joint was changed, too
            return False, f'there was no valid {topics.ROTOR_STATE} yet'
        if (age := time.monotonic() - self._seen) > parameters.input_timeout:
            return False, f'the last valid {topics.ROTOR_STATE} came {age:.1f} s ago'
        if (speed := abs(ratio.output_rate(self._speed))) > limit:
            too_fast = f'the shaft turns at {speed:.3g} rad/s'
            return False, f'{too_fast}; home_max_speed is {limit:g} rad/s'
        whole, rest = ratio.output_angle(*before, math)
        result = self._node.set_parameters_atomically([Parameter('rotor_zero', value=zero)])
        if not result.successful:
            return False, result.reason
        self._input.home(rotor_angle)
        was, now = math.degrees(TURN * whole + rest), math.degrees(parameters.home_angle)
        kept = f'rotor_zero {zero:.3f} rad, {self._monitor.zero_kept}'
        return True, f'the shaft was at {was:z.1f}° and is now {now:z.1f}° ({kept})'
