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
from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.home_file import home_text, read_home
from gear_kinematics.state.diagnostics import InputMonitor
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire import topics

_SPEED_SPAN = 100_000_000
"""ns between the positions that give a speed, at least: of messages at 1 kHz, one step of an
encoder with 4096 counts per turn would be 1.5 rad/s, and 0.08 rad/s at an output that rests."""


def restored(node: Node, path: Path, parameters: NodeParameters) -> NodeParameters:
    """Set the zero of the home file, if there is one; returns the parameters with it.

    Raises:
        HomeFileError: if the file cannot be used.
    """
    if not (home := read_home(path, parameters)):
        return parameters
    zero, homed = home
    node.set_parameters([Parameter('rotor_zero', value=zero)])
    given = parameters.rotor_zero
    instead = '' if given == zero else f'; that of the parameters, {given:g} rad, is not used'
    node.get_logger().info(
        f'rotor_zero {zero:.3f} rad restored from {path}, homed {homed}{instead}'
    )
    return replace(parameters, rotor_zero=zero)


class Homing:
    """Sets the zero of a node on request, and keeps it."""

    def __init__(
        self, node: Node, path: Path | None, rotor_input: RotorInput, monitor: InputMonitor
    ) -> None:
        """Open the service; `path` is that of the home file, if there is to be one."""
        self._node, self._path, self._input, self._monitor = node, path, rotor_input, monitor
        monitor.zero_kept = 'not kept: set home_file'
        if path:
            monitor.zero_kept = f'kept in {path}' if path.exists() else 'not kept: not homed yet'
        self._seen = 0.0  # time of the last valid input; s of a steady clock
        self._earlier: tuple[RotorSample, ...] = ()  # the last one or two, `_SPEED_SPAN` apart
        self._segment = 0  # of these
        node.create_service(Trigger, '~/home', self.answer)

    def note(self, sample: RotorSample) -> None:
        """Take note of a valid input, which says where the shaft is, and how fast it turns."""
        self._seen = time.monotonic()
        if self._segment != self._input.segment:  # other turns, or another zero
            self._segment, self._earlier = self._input.segment, ()
        if not self._earlier:
            self._earlier = (sample,)
        elif sample.stamp - self._earlier[-1].stamp >= _SPEED_SPAN:
            self._earlier = self._earlier[-1], sample

    def keep(self) -> None:
        """Write the zero that was set to the home file."""
        if not self._path:
            return
        try:
            replace_file(self._path, home_text(self._input.parameters).encode())
            self._monitor.zero_kept = f'kept in {self._path}'
        except OSError as error:  # the zero holds until the node ends
            self._monitor.zero_kept = f'not kept: {self._path}: {error.strerror}'
            self._node.get_logger().error(f'rotor_zero is {self._monitor.zero_kept}')

    def answer(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Declare that the output shaft is at `home_angle` now, or tell why not."""
        response.success, response.message = self._home()
        return response

    def _home(self) -> tuple[bool, str]:
        parameters, last = self._input.parameters, self._input.last
        ratio = parameters.gear.gear_ratio
        rotor_angle = ratio.rotor_angle(parameters.home_angle)
        try:
            zero = self._input.zero_for(rotor_angle)
        except RuntimeError:
            last = None
        if last is None:
            return False, f'there was no valid {topics.ROTOR_STATE} yet'
        if refusal := self._refusal(parameters, last):
            return False, refusal
        whole, rest = ratio.output_angle(*last.position, math)
        result = self._node.set_parameters_atomically([Parameter('rotor_zero', value=zero)])
        if not result.successful:
            return False, result.reason
        self._input.home(rotor_angle)
        was, now = _degrees(TURN * whole + rest), _degrees(parameters.home_angle)
        kept = f'rotor_zero {zero:.3f} rad, {self._monitor.zero_kept}'
        return True, f'the shaft was at {was} and is now {now} ({kept})'

    def _refusal(self, parameters: NodeParameters, last: RotorSample) -> str:
        """Why the output shaft is not known to be where it is said to be; '' if it is."""
        age = time.monotonic() - self._seen
        if age > parameters.input_timeout:
            came = f'the last valid {topics.ROTOR_STATE} came {age:.1f} s ago'
            return f'{came}: where the shaft is now is not known'
        speed = abs(parameters.gear.gear_ratio.output_rate(self._speed(last)))
        limit = parameters.home_max_speed
        if speed > limit:
            return f'the shaft turns at {speed:.3g} rad/s; home_max_speed is {limit:g} rad/s'
        return ''

    def _speed(self, last: RotorSample) -> float:
        """Speed of the rotor, rad/s: the last velocity, or the mean since an earlier position.

        That is the last one that is at least `_SPEED_SPAN` older; in the beginning the first one.
        Of a single message nothing says that the shaft turns, nor of one with another zero.
        """
        [earlier, *_] = self._earlier if self._segment == self._input.segment else [last]
        if last.velocity is not None or last.stamp == earlier.stamp:
            return last.velocity or 0.0
        turns, angle = (b - a for a, b in zip(earlier.position, last.position, strict=True))
        return (TURN * turns + angle) / (1e-9 * (last.stamp - earlier.stamp))


def _degrees(angle: float) -> str:
    return f'{round(math.degrees(angle), 1) + 0.0:.1f}°'  # no -0.0
