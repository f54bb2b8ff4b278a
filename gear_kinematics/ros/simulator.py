# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_simulator: an actuator without hardware, in real time."""

import math
import time
from collections.abc import Collection
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from gear_kinematics.parameters import PARAMETERS, NodeParameters, default_value
from gear_kinematics.parameters.files import require_any
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.node_parameters import declared, fault_of
from gear_kinematics.ros.outputs import Outputs, PublishingNode
from gear_kinematics.twin import parameters as twin
from gear_kinematics.twin.driver import Command, Driver
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.model import Model
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND, JointStateTemplate
from gear_kinematics.wire.nearest import among

_MOST_LATE = SECOND // 2  # ns of real time that are made up for
_ACCURACY = 100_000  # ns, of stamps
_GREATEST_LOAD = 1e6  # N·m


class GearSimulator(PublishingNode):
    """Moves a simulated gear, and publishes its encoders as drivers do."""

    def __init__(self, *, parameter_files: Collection[Path] = (), **options: Any) -> None:
        """Declare the parameters, open the topics and begin.

        Raises:
            ParameterException: if a parameter is refused.
            ValueError: if the parameters describe no gear that can be simulated, one is unknown,
                or the files have none for this node.
        """
        super().__init__(twin.NODE, **options)
        files = require_any(parameter_files, self.get_fully_qualified_name())
        self.add_on_set_parameters_callback(_check_parameters)
        if fault := _check_parameters([self.get_parameter('use_sim_time')]).reason:
            raise ValueError(fault)
        # What a file leaves out is as in gear_state_publisher with that file.
        shared = default_value if parameter_files else twin.default_value
        values = declared(
            self,
            twin.PARAMETERS,
            lambda name: (twin.default_value if name in twin.PARAMETERS else shared)(name),
            {name: replace(each, read_only=True) for name, each in PARAMETERS.items()},
        )
        parameters, own = NodeParameters.of(values), twin.TwinParameters.of(values)
        gear = TwinGear.of(parameters, own, files.get(parameters.calibration))
        self._model = _make_model(own.model, gear)
        self._driver = Driver(
            self._model,
            max_torque=own.max_rotor_torque,
            rotor_counts=own.rotor_counts,
            output_counts=own.output_counts,
            dropout=own.dropout,
        )
        self._joint, self._load = parameters.rotor_joint, 0.0
        self._period = round(SECOND / own.rate)
        self._outputs = Outputs(self, lambda _: None, self._note_unsent)
        qos = QoSProfile(depth=DEPTH)
        output = parameters.output_encoder_joint or parameters.output_joint
        self._joints = []
        for topic, joint, read in (
            (topics.ROTOR_STATE, self._joint or 'rotor', self._driver.rotor),
            (topics.OUTPUT_ENCODER, output, self._driver.output),
        ):
            self._outputs.create(topic, JointState, qos)
            template = JointStateTemplate([joint], velocity=True, effort=True)
            self._joints.append((topic, template, read))
        self.create_subscription(JointState, topics.ROTOR_COMMAND, self._on_command, qos)
        self.create_subscription(Float64, topics.LOAD_TORQUE, self._on_load, qos)
        for shaft in ('output', 'rotor'):
            self.create_service(SetBool, f'~/lock_{shaft}', partial(self._lock, shaft))
        self.create_service(Trigger, '~/power_cycle', self._power_cycle)
        self.create_service(Trigger, '~/wear', self._wear)
        self.get_logger().info(
            f'simulating a gear of ratio {parameters.gear.gear_ratio} with '
            f'{type(self._model).__name__} at {own.rate:g} Hz'
        )
        self._offset = 0
        """Of the node's clock, ns."""
        self._due = time.monotonic_ns() + self._period
        """When the next state is due, ns of a steady clock."""
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(self._period / SECOND, self._step, clock=steady)

    def _step(self) -> None:
        """Let the time pass that has passed, and publish the states of it."""
        now = time.monotonic_ns()
        late = now - self._due
        if late > _MOST_LATE:
            self._warn(f'{late / SECOND:.2f} s behind real time, which are left out: '
                       'the processor is busy, or the rate is too high')  # fmt: skip
            self._due += late
        self._compare_clocks()
        while self._due <= now:
            self._driver.advance(self._period / SECOND, self._load)
            if self._model.notice:
                self._warn(self._model.notice)
                self._model.notice = ''
            stamp = max(self._due + self._offset, 0)
            self._outputs.send(
                (topic, template.encode(stamp, read()))
                for topic, template, read in self._joints
                if not self._driver.drops()
            )
            self._due += self._period

    def _compare_clocks(self) -> None:
        """Find when the states are in the node's clock, unless something came in between."""
        before = time.monotonic_ns()
        now = self.get_clock().now().nanoseconds
        if time.monotonic_ns() - before < _ACCURACY or not self._offset:
            self._offset = now - before

    def _on_command(self, message: JointState) -> None:
        """Follow a command; values that are absent or not finite are not commanded."""
        only = len(message.name) == 1
        joint = self._joint or (message.name[0] if only else '')
        if joint not in message.name or not (self._joint or only):
            fault = f'no joint {joint!r} in it{among(joint, message.name)}'
            if not self._joint:
                fault = f'{len(message.name)} joints in it: set rotor_joint to one of them'
            self._warn(f'{topics.ROTOR_COMMAND} rejected: {fault}')
            return
        index = message.name.index(joint)
        arrays = message.position, message.velocity, message.effort
        values = (values[index] if index < len(values) else math.nan for values in arrays)
        command = Command(*(value if math.isfinite(value) else None for value in values))
        if any(value is not None for value in command):
            self._driver.follow(command)
        else:
            self._warn(f'{topics.ROTOR_COMMAND} rejected: no value in it is finite')

    def _on_load(self, message: Float64) -> None:
        if abs(message.data) <= _GREATEST_LOAD:  # NaN is not
            self._load = message.data
        else:
            self._warn(
                f'{topics.LOAD_TORQUE} rejected: {message.data:g} N·m is not within '
                f'±{_GREATEST_LOAD:g} N·m'
            )

    def _lock(self, shaft: str, request: SetBool.Request, response: Any) -> Any:
        setattr(self._model, f'{shaft}_locked', request.data)
        return _told(response, f'the {shaft} is {"locked" if request.data else "free"}')

    def _power_cycle(self, _: Trigger.Request, response: Any) -> Any:
        self._driver.power_cycle()
        position, *_ = self._driver.rotor()
        return _told(response, f'the driver is on again: the rotor is free, at {position:.3f} rad')

    def _wear(self, _: Trigger.Request, response: Any) -> Any:
        angle = self.get_parameter('wear').value
        gear = self._model.gear = self._model.gear.worn(angle)
        left = f'a preload of {gear.preload:.2f} N·m is left'
        if not gear.preload:
            left = f'the output has a play of {1e3 * -gear.interference:.2f} mrad'
        return _told(response, f'the flanks wore off by {1e3 * angle:.2f} mrad: {left}')

    def _note_unsent(self, publisher: Publisher, error: Exception) -> None:
        self._warn(f'{publisher.topic_name} not sent: {error}')


def _make_model(kind: str, gear: TwinGear) -> Model:
    """Make the model that the parameter `model` selects; raises ImportError if it is missing."""
    if kind == 'fast' or (kind == 'auto' and not find_spec('mujoco')):
        return FastModel(gear)
    from gear_kinematics.twin.mujoco_model import MujocoModel  # noqa: PLC0415, an extra

    return MujocoModel(gear)


def _check_parameters(changed: list[Parameter]) -> SetParametersResult:
    """Refuse values that are invalid beyond type and range, which rclpy checks."""
    known = {**PARAMETERS, **twin.PARAMETERS}
    reason = next(filter(None, (fault_of(parameter, known) for parameter in changed)), '')
    if any(parameter.name == 'use_sim_time' and parameter.value for parameter in changed):
        reason = 'use_sim_time must be false: gear_simulator moves the gear in real time'
    return SetParametersResult(successful=not reason, reason=reason)


def _told(response: Any, message: str) -> Any:
    response.success, response.message = True, message
    return response
