# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The services that home, and the zeros that are kept in the home file."""

import math
import time
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from pathlib import Path

from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import full_name, labelled
from gear_kinematics.parameters.home_file import read_home, write_home
from gear_kinematics.state.monitors import InputMonitor
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND

_SPEED_SPAN = 100_000_000
"""ns between the positions that give a speed, at least: of messages at 1 kHz, one step of an
encoder with 4096 counts per turn would be 1.5 rad/s, and 0.08 rad/s at an output that rests."""


class _RefusedError(RuntimeError):
    """Why a shaft cannot be homed."""


def restored(
    node: Node, path: Path, actuators: Mapping[str, NodeParameters]
) -> Mapping[str, float]:
    """Set the zeros of the home file, if there is one; returns them by actuator.

    Raises:
        ConfigError: if the file cannot be used.
    """
    if not (home := read_home(path, actuators, node.get_fully_qualified_name())):
        return {}
    zeros, homed = home
    named = {full_name(name, 'rotor_zero'): zero for name, zero in zeros.items()}
    node.set_parameters([Parameter(name, value=zero) for name, zero in named.items()])
    which = ', '.join(f'{name} {zero:.3f} rad' for name, zero in named.items())
    node.get_logger().info(f'{which} restored from {path}, homed {homed}')
    return zeros


class Shaft:
    """The shaft of an actuator: where it is, and how fast its rotor turns."""

    def __init__(self, rotor_input: RotorInput, monitor: InputMonitor) -> None:
        """Follow an input; the monitor reports where its zero is kept."""
        self.input, self.monitor = rotor_input, monitor
        self._seen = 0.0  # time of the last valid input; s of a steady clock
        self._before: RotorSample | None = None  # where `_speed` was measured
        self._segment, self._due = -1, 0  # of that, and the stamp of the next measurement, ns
        self._speed = 0.0  # of the rotor, rad/s

    def note(self, sample: RotorSample, segment: int, now: float) -> None:
        """Take note of a valid input, which came now.

        Without a velocity the speed is the mean over `_SPEED_SPAN`; 0 until there is one.
        """
        self._seen = now
        stamp, position, velocity, _ = sample
        if not (before := self._before) or self._segment != segment:  # other turns or zero
            self._segment, self._speed = segment, 0.0
            self._before, self._due = sample, stamp + _SPEED_SPAN
        elif stamp >= self._due:
            elapsed = (stamp - before.stamp) / SECOND
            self._speed = position.since(before.position) / elapsed
            self._before, self._due = sample, stamp + _SPEED_SPAN
        if velocity is not None:
            self._speed = velocity

    @property
    def rotor_angle(self) -> float:
        """The angle of the rotor at `home_angle`, rad."""
        parameters = self.input.parameters
        return float(parameters.gear.gear_ratio.rotor_angle(parameters.home_angle))

    def zero(self) -> tuple[float, str]:
        """Find `rotor_zero` for a shaft at `home_angle`, rad; says where the shaft was and is.

        Raises:
            _RefusedError: if the shaft cannot be homed; the text says why.
        """
        parameters, turns = self.input.parameters, self.input.turns
        ratio, limit = parameters.gear.gear_ratio, parameters.home_max_speed
        try:
            zero = self.input.zero_for(self.rotor_angle)
            before = turns.relative_to(self.input.zero, parameters.rotor_direction)
        except RuntimeError as error:  # after the joint was changed, too
            raise _RefusedError(f'there was no valid {topics.ROTOR_STATE} yet') from error
        if (age := time.monotonic() - self._seen) > parameters.input_timeout:
            raise _RefusedError(f'the last valid {topics.ROTOR_STATE} came {age:.1f} s ago')
        if (speed := abs(ratio.output_rate(self._speed))) > limit:
            too_fast = f'the shaft turns at {speed:.3g} rad/s'
            raise _RefusedError(f'{too_fast}; home_max_speed is {limit:g} rad/s')
        whole, rest = ratio.output_angle(*before, math)
        was, now = math.degrees(TURN * whole + rest), math.degrees(parameters.home_angle)
        return zero, f'the shaft was at {was:z.1f}° and is now {now:z.1f}°'


class Homing:
    """Sets the zeros of a node on request, and keeps them."""

    def __init__(
        self, node: Node, path: Path | None, shafts: Mapping[str, Shaft], kept: Collection[str]
    ) -> None:
        """Open a service for each shaft of an arm, and one for all.

        `path` is that of the home file, if there is to be one, and `kept` names the shafts whose
        zeros are in it.
        """
        self._node, self._path, self._shafts, self._set = node, path, shafts, set(kept)
        for name, shaft in shafts.items():
            shaft.monitor.zero_kept = Condition.ZERO_IS_LOST()
            if path:
                known = Condition.ZERO_KEPT if name in kept else Condition.ZERO_NOT_SET
                shaft.monitor.zero_kept = known(path=path)
            if name:
                node.create_service(Trigger, f'~/{name}/home', partial(self._answer, [name]))
        node.create_service(Trigger, '~/home', self.answer)

    def keep(self, names: Collection[str]) -> None:
        """Write the zeros that were set to the home file, after some were set."""
        self._set.update(names)
        if not self._path:
            return
        zeros = {
            name: each.input.parameters for name, each in self._shafts.items() if name in self._set
        }
        try:
            write_home(self._path, zeros, self._node.get_fully_qualified_name())
            kept = Condition.ZERO_KEPT(path=self._path)
        except OSError as error:  # the zeros hold until the node ends
            kept = Condition.ZERO_NOT_KEPT(path=self._path, why=error.strerror)
        for name in zeros:
            self._shafts[name].monitor.zero_kept = kept

    def answer(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Declare that the output shafts are at `home_angle` now, or tell why none is."""
        return self._answer([*self._shafts], request, response)

    def _answer(
        self, names: Sequence[str], _request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        response.success, response.message = self._home(names)
        return response

    def _home(self, names: Sequence[str]) -> tuple[bool, str]:
        """Home all of some shafts or none."""
        found, refused = {}, []
        for name in names:
            try:
                found[name] = self._shafts[name].zero()
            except _RefusedError as error:
                refused.append(labelled(name, str(error)))
        if refused:
            none = 'no shaft was homed: ' if len(names) > 1 else ''
            return False, none + '; '.join(refused)
        angles = [(self._shafts[name], self._shafts[name].rotor_angle) for name in names]
        result = self._node.set_parameters_atomically(
            [Parameter(full_name(name, 'rotor_zero'), value=found[name][0]) for name in names]
        )
        if not result.successful:
            return False, result.reason
        texts = []
        for name, (shaft, rotor_angle) in zip(names, angles, strict=True):
            shaft.input.home(rotor_angle)
            zero, moved = found[name]
            kept = f'rotor_zero {zero:.3f} rad, {shaft.monitor.zero_kept}'
            texts.append(labelled(name, f'{moved} ({kept})'))
        return True, '; '.join(texts)
