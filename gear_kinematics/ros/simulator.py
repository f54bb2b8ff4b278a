# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_simulator: an actuator, or those of an arm, without hardware, in real time."""

import math
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import Any, Self

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from gear_kinematics.parameters import PARAMETERS, NodeParameters, default_value
from gear_kinematics.parameters.arm import by_actuator, full_name, labelled
from gear_kinematics.parameters.files import require_any
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.node_parameters import declared_actuators, fault_of
from gear_kinematics.ros.outputs import PublishingNode
from gear_kinematics.twin import parameters as twin
from gear_kinematics.twin.driver import Command, Driver
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND, JointStateTemplate
from gear_kinematics.wire.nearest import among

_MOST_LATE = SECOND // 2  # ns of real time that are made up for
_ACCURACY = 100_000  # ns, of stamps
_GREATEST_LOAD = 1e6  # N·m


class GearSimulator(PublishingNode):
    """Moves simulated gears, and publishes their encoders as drivers do."""

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
        # With a file, the defaults are those that gear_state_publisher has with the same file.
        shared = default_value if parameter_files else twin.default_value
        actuators = declared_actuators(
            self,
            twin.PARAMETERS,
            lambda name: (twin.default_value if name in twin.PARAMETERS else shared)(name),
            {name: replace(each, read_only=True) for name, each in PARAMETERS.items()},
        )
        values = {name: each.value for name, each in self.get_parameters_by_prefix('').items()}
        own = {name: twin.TwinParameters.of(each) for name, each in by_actuator(values).items()}
        if len({(each.rate, each.dropout) for each in own.values()}) > 1:
            raise ValueError('rate and dropout are those of all actuators')
        self._gears = [
            SimulatedGear.of(parameters, own[name], files)
            for name, parameters in actuators.items()
        ]
        rate = next(iter(own.values())).rate
        self._period = round(SECOND / rate)
        qos = QoSProfile(depth=DEPTH)
        self._encoders = []
        for topic, joints, read in (
            (topics.ROTOR_STATE, [gear.joint or 'rotor' for gear in self._gears], Driver.rotor),
            (topics.OUTPUT_ENCODER, [gear.output_joint for gear in self._gears], Driver.output),
        ):
            self.open_output(topic, qos)
            template = JointStateTemplate(joints, velocity=True, effort=True)
            self._encoders.append((topic, template, read))
        self.create_subscription(JointState, topics.ROTOR_COMMAND, self._on_command, qos)
        for gear in self._gears:
            self._open(gear, qos)
        gears = ', '.join(gear.title for gear in self._gears)
        self.get_logger().info(f'simulating {gears} at {rate:g} Hz')
        self._offset = 0  # lead of the node's clock over the steady clock, ns
        self._due = time.monotonic_ns() + self._period  # when the next state is due, ns (steady)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(self._period / SECOND, self._step, clock=steady)

    def _open(self, gear: 'SimulatedGear', qos: QoSProfile) -> None:
        name = f'{gear.name}/' * bool(gear.name)
        self.create_subscription(
            Float64, f'{name}{topics.LOAD_TORQUE}', partial(self._on_load, gear), qos
        )
        for shaft in ('output', 'rotor'):
            service = f'~/{name}lock_{shaft}'
            self.create_service(SetBool, service, partial(_lock, gear.model, shaft))
        self.create_service(Trigger, f'~/{name}power_cycle', partial(_power_cycle, gear.driver))
        self.create_service(Trigger, f'~/{name}wear', partial(self._wear, gear))

    def _step(self) -> None:
        """Advance the model by the time that has passed, and publish its states."""
        now = time.monotonic_ns()
        late = now - self._due
        if late > _MOST_LATE:
            self._warn(f'skipped {late / SECOND:.2f} s to catch up with real time: '
                       'the processor is busy, or the rate is too high')  # fmt: skip
            self._due += late
        self._compare_clocks()
        while self._due <= now:
            for gear in self._gears:
                gear.driver.advance(self._period / SECOND, gear.load)
                if gear.model.notice:
                    self._warn(labelled(gear.name, gear.model.notice))
                    gear.model.notice = ''
            stamp, drivers = max(self._due + self._offset, 0), [g.driver for g in self._gears]
            self.send(
                (topic, template.encode(stamp, [*chain(*zip(*map(read, drivers), strict=True))]))
                for topic, template, read in self._encoders
                if not drivers[0].drops()
            )
            self._due += self._period

    def _compare_clocks(self) -> None:
        """Compare the clocks, unless the process was preempted between the two readings."""
        before = time.monotonic_ns()
        now = self.get_clock().now().nanoseconds
        if time.monotonic_ns() - before < _ACCURACY or not self._offset:
            self._offset = now - before

    def _on_command(self, message: JointState) -> None:
        """Follow a command; values that are absent or not finite are not commanded."""
        names, joints = list(message.name), [gear.joint for gear in self._gears]
        if joints == [''] and len(names) == 1:
            joints = names
        elif joints == ['']:
            fault = f'{len(names)} joints in it: set rotor_joint to one of them'
            self._warn(f'{topics.ROTOR_COMMAND} rejected: {fault}')
            return
        commanded = [each for each in zip(self._gears, joints, strict=True) if each[1] in names]
        if not commanded:
            missing = ' or '.join(map(repr, joints))
            fault = f'no joint {missing} in it{among(joints[0], names)}'
            self._warn(f'{topics.ROTOR_COMMAND} rejected: {fault}')
        for gear, joint in commanded:
            index = names.index(joint)
            arrays = message.position, message.velocity, message.effort
            values = (values[index] if index < len(values) else math.nan for values in arrays)
            command = Command(*(value if math.isfinite(value) else None for value in values))
            if any(value is not None for value in command):
                gear.driver.follow(command)
            else:
                fault = labelled(gear.name, 'no value in it is finite')
                self._warn(f'{topics.ROTOR_COMMAND} rejected: {fault}')

    def _on_load(self, gear: 'SimulatedGear', message: Float64) -> None:
        if abs(message.data) <= _GREATEST_LOAD:  # NaN is not
            gear.load = message.data
        else:
            fault = f'{message.data:g} N·m is not within ±{_GREATEST_LOAD:g} N·m'
            self._warn(labelled(gear.name, f'{topics.LOAD_TORQUE} rejected: {fault}'))

    def _wear(self, worn: 'SimulatedGear', _: Trigger.Request, response: Any) -> Any:
        angle = self.get_parameter(full_name(worn.name, 'wear')).value
        gear = worn.model.gear = worn.model.gear.worn(angle)
        left = f'a preload of {gear.preload:.2f} N·m is left'
        if not gear.preload:
            left = f'the output has {1e3 * -gear.interference:.2f} mrad of play'
        return _told(response, f'the flanks lost {1e3 * angle:.2f} mrad: {left}')


@dataclass(slots=True)
class SimulatedGear:
    """A gear with its motor and its encoders."""

    name: str  # of the actuator; '' of the only one
    joint: str  # of the rotor; '' takes the only one of a command
    output_joint: str
    model: TwinModel
    driver: Driver
    load: float = 0.0  # N·m

    @classmethod
    def of(
        cls, parameters: NodeParameters, own: twin.TwinParameters, files: Mapping[str, Path]
    ) -> Self:
        """Simulate the gear of an actuator; `files` are calibrations by values of parameters."""
        gear = TwinGear.of(parameters, own, files.get(parameters.calibration))
        model = _make_model(own.model, gear)
        output = parameters.output_encoder_joint or parameters.output_joint
        joint, driver = parameters.rotor_joint, Driver(model, own)
        return cls(parameters.actuator, joint, output, model, driver)

    @property
    def title(self) -> str:
        """The simulated gear and the kind of the model, in words."""
        ratio = self.model.gear.parameters.gear.gear_ratio
        return f'{self.name or "a gear"} of ratio {ratio} with {type(self.model).__name__}'


def _lock(model: TwinModel, shaft: str, request: SetBool.Request, response: Any) -> Any:
    setattr(model, f'{shaft}_locked', request.data)
    return _told(response, f'the {shaft} is {"locked" if request.data else "free"}')


def _power_cycle(driver: Driver, _: Trigger.Request, response: Any) -> Any:
    driver.power_cycle()
    position, *_ = driver.rotor()
    return _told(response, f'the driver is on again: the rotor is free, at {position:.3f} rad')


def _make_model(kind: str, gear: TwinGear) -> TwinModel:
    """Make the model that the parameter `model` selects; raises ImportError if it is missing.

    MuJoCo needs the bodies, which are unknown of a gear known by its ratio alone.
    """
    by_ratio = bool(gear.parameters.gear_ratio)
    if kind == 'fast' or (kind == 'auto' and (by_ratio or not find_spec('mujoco'))):
        return FastModel(gear)
    from gear_kinematics.twin.mujoco_model import MujocoModel  # noqa: PLC0415, an extra

    return MujocoModel(gear)


def _check_parameters(changed: list[Parameter]) -> SetParametersResult:
    known = {**PARAMETERS, **twin.PARAMETERS}
    reason = next(filter(None, (fault_of(parameter, known) for parameter in changed)), '')
    if any(parameter.name == 'use_sim_time' and parameter.value for parameter in changed):
        reason = 'use_sim_time must be false: gear_simulator moves the gear in real time'
    return SetParametersResult(successful=not reason, reason=reason)


def _told(response: Any, message: str) -> Any:
    response.success, response.message = True, message
    return response
