# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_state_publisher: parameters, topics and diagnostics; no mathematics."""

import time
import traceback
from collections.abc import Collection, Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState, MultiDOFJointState
from std_msgs.msg import Bool

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NODE, PARAMETERS, NodeParameters
from gear_kinematics.parameters.files import require_any
from gear_kinematics.ros.diagnostics import diagnostic_array, find_faults
from gear_kinematics.ros.display import Display
from gear_kinematics.ros.driver_log import DriverLog
from gear_kinematics.ros.drivers import DEPTH, DriverInput
from gear_kinematics.ros.homing import Homing, restored
from gear_kinematics.ros.node_parameters import declared, fault_of
from gear_kinematics.ros.other_gears import OtherGears
from gear_kinematics.ros.outputs import Outputs, PublishingNode, latched
from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.loads import PreloadMonitor
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.wire import topics
from gear_kinematics.wire.joint_reader import JOINT_MISSING, RejectedInputError

_MESSAGE_TYPES = {
    topics.JOINT_STATE: JointState,
    topics.POSE_ARRAY: PoseArray,
    topics.WRENCHES: MultiDOFJointState,
}
_REPORT_PERIOD = 1.0  # s


class GearStatePublisher(PublishingNode):
    """Publishes the state of the mechanism for every valid message on rotor_state."""

    def __init__(self, *, parameter_files: Collection[Path] = (), **options: Any) -> None:
        """Declare the parameters, of which the files must have some, and open the topics.

        Raises:
            ParameterException: if a parameter is refused.
            ValueError: if the parameters describe no gear, one is unknown, the files have none
                for this node, or the calibration or the home file cannot be used.
        """
        super().__init__(NODE, **options)
        self._files = require_any(parameter_files, self.get_fully_qualified_name())
        self.add_on_set_parameters_callback(self._check_parameters)
        parameters = NodeParameters.of(declared(self))
        if home_file := self._file(parameters.home_file):
            home_file = home_file.absolute()
            parameters = restored(self, home_file, parameters)
        self._gear = parameters.gear
        self._actuator = GearState(parameters, self._calibration(parameters.calibration))
        self._display: Display | None = None
        self._preload = PreloadMonitor(parameters) if parameters.preload else None
        self._monitor = InputMonitor(started=time.monotonic())
        self._encoder_monitor = EncoderMonitor()

        self._outputs = Outputs(self, self._note_subscribers, self._note_unsent)
        for topic in self._actuator.topics:
            message_type = _MESSAGE_TYPES[topics.TOPICS[topic].type]
            self._outputs.create(topic, message_type, QoSProfile(depth=DEPTH))
        self._note_subscribers()
        self._outputs.create(topics.REFERENCED, Bool, latched())
        self._referenced: bool | None = None  # as it was published last
        self._outputs.create(topics.DIAGNOSTICS, DiagnosticArray, QoSProfile(depth=10))
        if isinstance(self._gear, Mechanism):
            self._display = Display(self, parameters, self._outputs)
            self._display.update(parameters)
        self.add_post_set_parameters_callback(self._configure)
        self._homing = Homing(self, home_file, self._actuator.input, self._monitor)
        # A missing input must be reported even while a simulated clock is paused.
        self.create_timer(
            _REPORT_PERIOD, self._report, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self._drivers = self._rotor_driver, _ = (
            DriverInput(self, topics.ROTOR_STATE, self._on_rotor_state, self._monitor),
            DriverInput(
                self, topics.OUTPUT_ENCODER, self._on_output_encoder, self._encoder_monitor
            ),
        )
        self._driver_log = DriverLog(self, self._actuator.input)
        self._other_gears = OtherGears(self)
        known = 'bodies unknown'
        if isinstance(self._gear, Mechanism):
            known = f'ring {self._gear.ring_teeth}, satellite {self._gear.satellite_teeth} teeth'
        joint = parameters.rotor_joint
        listening_for = f'joint {joint!r}' if joint else 'the only joint'
        self.get_logger().info(
            f'gear ratio {self._gear.gear_ratio} ({known}), listening for {listening_for} '
            f'on {self._rotor_driver.subscription.topic_name}'
        )

    def _note_subscribers(self, _event: object = None) -> None:
        """Let only the outputs with subscribers be computed."""
        self._actuator.choose(self._outputs.subscribed(self._actuator.topics))

    def _check_parameters(self, changed: list[Parameter]) -> SetParametersResult:
        """Refuse values that are invalid beyond type and range, which rclpy checks."""
        try:
            reason = next(filter(None, map(fault_of, changed)), '')
            if not reason and hasattr(self, '_actuator'):  # else the constructor checks them
                self._prepare((parameter.name, parameter.value) for parameter in changed)
        except ValueError as error:
            reason = str(error)
        except Exception as error:  # noqa: BLE001, nothing that is set may end the node
            reason = f'unexpected {type(error).__name__}: {error}'
            self.get_logger().error(traceback.format_exc())
        return SetParametersResult(successful=not reason, reason=reason)

    def _prepare(self, changed: Iterable[tuple[str, Any]]) -> None:
        """Make what the changed parameters affect and can be refused for, also one set twice."""
        parameters, calibration = self._actuator.parameters, self._actuator.calibration
        for name, value in changed:
            if name in PARAMETERS:
                parameters = replace(parameters, **{name: value})
                state_messages(parameters)  # to check the names
            if name == 'calibration':
                calibration = self._calibration(value)
        self._prepared = parameters, calibration

    def _calibration(self, value: str) -> Calibration | None:
        """Load the calibration that a value of the parameter names, if any."""
        path = self._file(value)
        return Calibration.load(path, self._gear) if path else None

    def _file(self, value: str) -> Path | None:
        """Return the file that a value of a parameter names, if any."""
        return self._files.get(value, Path(value)) if value else None

    def _configure(self, changed: Collection[Parameter]) -> None:
        """Apply what was prepared, after every change."""
        self._actuator.apply(*self._prepared)
        if self._display:
            self._display.update(self._actuator.parameters)
        if any(parameter.name == 'rotor_zero' for parameter in changed):
            self._homing.keep()

    def _on_rotor_state(self, data: bytes) -> None:
        try:
            answer = self._actuator.rotor(data, self._now)
        except RejectedInputError as rejection:
            self._warn_of(topics.ROTOR_STATE, rejection)
            return
        self._monitor.last_input = time.monotonic()
        sample, segment, referenced, withheld = answer[:4]
        if self._driver_log.awaited:
            self._driver_log.heard(sample)
        self._homing.note(sample, segment)
        if referenced is not self._referenced:
            self._publish_referenced(referenced)
        self._outputs.send(self._actuator.encode(answer))
        self._monitor.published += not withheld
        self._monitor.unreferenced += not referenced
        if self._preload:
            self._preload.follow(sample, segment)
        if self._actuator.input.referenced is not referenced:  # by the output's encoder
            self._publish_referenced(self._actuator.input.referenced)

    def _publish_referenced(self, referenced: bool) -> None:  # noqa: FBT001, what is published
        """Publish at once that the turns have become known or unknown."""
        changed = self._referenced is not None
        self._referenced = referenced
        self._outputs.send([(topics.REFERENCED, serialize_message(Bool(data=referenced)))])
        if changed:
            self._publish_diagnostics()

    def _on_output_encoder(self, data: bytes) -> None:
        self._encoder_monitor.last_input = time.monotonic()
        try:
            errors = self._actuator.encoder(data, self._now)
        except RejectedInputError as rejection:
            self._warn_of(topics.OUTPUT_ENCODER, rejection)
            return
        self._outputs.send(self._actuator.encode_errors(errors))
        referenced = self._actuator.input.referenced
        if self._referenced not in (None, referenced):
            self._publish_referenced(referenced)

    def _note_unsent(self, publisher: Publisher, error: Exception) -> None:
        # For example, with history keep_all and a blocked subscriber.
        self._monitor.unsent += 1
        self._warn(f'{publisher.topic_name} not sent: {error}')

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _warn_of(self, topic: str, rejection: RejectedInputError) -> None:
        if topic == topics.ROTOR_STATE:
            if str(rejection) == JOINT_MISSING not in self._actuator.input.rejected:
                return  # a message of another driver on a shared topic, and no input
            self._monitor.last_input = time.monotonic()
        if time.monotonic() >= self._next_warning:
            detail = f': {rejection.detail}' if rejection.detail else ''
            self._warn(f'{topic} rejected: {rejection}{detail}')

    def _report(self) -> None:
        for driver in self._drivers:
            driver.count_losses()
        self._look_at_graph()
        now, last = time.monotonic(), self._monitor.last_input
        self._driver_log.update(self._monitor.drivers, now - (last or now))
        self._publish_diagnostics()

    def _publish_diagnostics(self) -> None:
        now, rotor = time.monotonic(), self._actuator.input
        encoder = self._actuator.output_encoder
        errors = self._encoder_monitor.report(encoder, self._actuator.parameters, now)
        received = self._monitor.report(rotor, now, encoder.reference)
        preload = self._preload.report() if self._preload else None
        reports = {'rotor input': received, 'transmission error': errors, 'preload': preload}
        message = serialize_message(diagnostic_array(self, reports))
        self._outputs.send([(topics.DIAGNOSTICS, message)])

    def _look_at_graph(self) -> None:
        """Check the connections with other nodes, and log new faults."""
        known = self._monitor.graph
        inputs = (driver.subscription for driver in self._drivers)
        publishers = self._outputs.publishers.values()
        found = self._monitor.graph = find_faults(
            self, inputs, publishers, topics.STATE_TOPICS, self._other_gears.clash
        )
        for fault in (*found.errors, *found.warnings):
            if fault not in (*known.errors, *known.warnings):
                self.get_logger().warning(fault)
