# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_state_publisher: parameters, topics and diagnostics; no mathematics."""

import time
import traceback
from collections.abc import Collection, Iterable, Sequence
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
from gear_kinematics.correction.corrector import Corrector
from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NODE, PARAMETERS, NodeParameters
from gear_kinematics.parameters.files import require_any
from gear_kinematics.ros.diagnostics import diagnostic_array, find_faults
from gear_kinematics.ros.display import Display
from gear_kinematics.ros.drivers import DEPTH, DriverInput
from gear_kinematics.ros.homing import Homing, restored
from gear_kinematics.ros.missing_publisher import MissingPublisher
from gear_kinematics.ros.node_parameters import declared, fault_of
from gear_kinematics.ros.outputs import Outputs, PublishingNode, latched
from gear_kinematics.state.diagnostics import EncoderMonitor, InputMonitor
from gear_kinematics.state.loads import Loads, PreloadMonitor
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.state.turn_reference import TurnReference
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
        self._settings = parameters
        self._gear = parameters.gear
        self._input = RotorInput(parameters)
        self._reference = TurnReference(self._input)
        self._encoder = OutputEncoder(parameters, self._reference)
        self._corrector: Corrector | None = None
        self._display: Display | None = None
        self._loads: Loads | None = None
        self._preload = PreloadMonitor(parameters) if parameters.preload else None
        self._prepare([('calibration', parameters.calibration)])
        self._configure()
        self._monitor = InputMonitor(started=time.monotonic())
        self._encoder_monitor = EncoderMonitor()

        self._outputs = Outputs(self, self._note_subscribers, self._note_unsent)
        for topic in (
            *self._messages.topics,
            *topics.CORRECTED_TOPICS,
            topics.TRANSMISSION_ERROR,
            *(topics.LOAD_TOPICS if isinstance(self._gear, Mechanism) else ()),
        ):
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
        self._homing = Homing(self, home_file, self._input, self._monitor)
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
        self._missing_publisher = MissingPublisher(self)
        known = 'bodies unknown'
        if isinstance(self._gear, Mechanism):
            known = f'ring {self._gear.ring_teeth}, satellite {self._gear.satellite_teeth} teeth'
        joint = parameters.rotor_joint
        listening_for = f'joint {joint!r}' if joint else 'the only joint'
        self.get_logger().info(
            f'gear ratio {self._gear.gear_ratio} ({known}), listening for {listening_for} '
            f'on {self._rotor_driver.subscription.topic_name}'
        )

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; the reason of a refusal always names the parameter."""
        result = super().set_parameters_atomically(parameter_list)
        names = ', '.join(parameter.name for parameter in parameter_list)
        if not result.successful and names not in result.reason:
            result.reason = f'{names}: {result.reason}'
        return result

    def _note_subscribers(self, _event: object = None) -> None:
        """Update the lists of outputs with subscribers, as only these are computed."""
        subscribed = self._outputs.subscribed
        self._subscribed_states = subscribed(self._messages.topics)
        self._subscribed_corrections = subscribed(topics.CORRECTED_TOPICS)
        self._subscribed_errors = subscribed([topics.TRANSMISSION_ERROR])
        self._subscribed_loads = subscribed(topics.LOAD_TOPICS if self._loads else ())

    def _check_parameters(self, changed: list[Parameter]) -> SetParametersResult:
        """Refuse values that are invalid beyond type and range, which rclpy checks."""
        try:
            reason = next(filter(None, map(fault_of, changed)), '')
            if not reason and hasattr(self, '_gear'):  # else the constructor checks them
                self._prepare((parameter.name, parameter.value) for parameter in changed)
        except ValueError as error:
            reason = str(error)
        except Exception as error:  # noqa: BLE001, nothing that is set may end the node
            reason = f'unexpected {type(error).__name__}: {error}'
            self.get_logger().error(traceback.format_exc())
        return SetParametersResult(successful=not reason, reason=reason)

    def _prepare(self, changed: Iterable[tuple[str, Any]]) -> None:
        """Make what the changed parameters affect and can be refused for, also one set twice."""
        settings, corrector = self._settings, self._corrector
        messages = state_messages(settings)
        for name, value in changed:
            if name in PARAMETERS:
                settings = replace(settings, **{name: value})
                messages = state_messages(settings)
            if name == 'calibration':
                corrector = self._corrector_of(value)
        self._prepared = settings, messages, corrector

    def _corrector_of(self, value: str) -> Corrector | None:
        """Load the calibration that a value of the parameter names, if any."""
        path = self._file(value)
        return Corrector(Calibration.load(path, self._gear)) if path else None

    def _file(self, value: str) -> Path | None:
        """Return the file that a value of a parameter names, if any."""
        return self._files.get(value, Path(value)) if value else None

    def _configure(self, changed: Collection[Parameter] = ()) -> None:
        """Apply what was prepared, at the start and after every change."""
        self._settings, self._messages, self._corrector = self._prepared
        self._input.parameters = self._settings
        if isinstance(self._gear, Mechanism):
            self._loads = Loads(self._settings)
        if changed:
            self._encoder.configure(self._settings)  # discards earlier errors
        if self._corrector:
            self._corrector.reset()
            self._corrector.max_acceleration = self._settings.max_rotor_acceleration
        if self._display:
            self._display.update(self._settings)
        if any(parameter.name == 'rotor_zero' for parameter in changed):
            self._homing.keep()

    def _on_rotor_state(self, data: bytes) -> None:
        self._monitor.last_input = time.monotonic()
        try:
            sample = self._input.accept(data, self._now)
        except RejectedInputError as rejection:
            self._warn_of(topics.ROTOR_STATE, rejection)
            return
        self._homing.note(sample)
        if (referenced := self._input.referenced) is not self._referenced:
            self._publish_referenced()
        if not referenced:
            self._monitor.unreferenced += 1
        published = referenced or self._settings.unreferenced_outputs == 'publish'
        if published:
            self._outputs.send(self._messages.encode(sample, self._subscribed_states))
        correction = None
        if self._corrector:  # also without a listener, to follow the motion
            correction = self._corrector.correct(
                sample, segment=self._input.segment, referenced=referenced
            )
            wanted = self._subscribed_corrections if published else ()
            self._outputs.send(self._messages.encode_corrected(sample, correction, wanted))
        if self._preload:
            self._preload.follow(sample, self._input.segment)
        if self._loads and self._subscribed_loads and published:
            loads = self._loads.follow(sample, self._input.segment)
            self._outputs.send(self._loads.encode(sample.stamp, loads, self._subscribed_loads))
        self._monitor.published += published
        if self._encoder.received and (referenced or self._settings.absolute):
            self._publish_errors(self._encoder.follow(sample, correction))
            if self._input.referenced is not referenced:
                self._publish_referenced()

    def _publish_referenced(self) -> None:
        """Publish at once that the turns have become known or unknown."""
        self._referenced = self._input.referenced
        message = serialize_message(Bool(data=self._referenced))
        self._outputs.send([(topics.REFERENCED, message)])

    def _on_output_encoder(self, data: bytes) -> None:
        self._encoder_monitor.last_input = time.monotonic()
        try:
            self._publish_errors(self._encoder.accept(data, self._now))
            if self._referenced not in (None, self._input.referenced):
                self._publish_referenced()
        except RejectedInputError as rejection:
            self._warn_of(topics.OUTPUT_ENCODER, rejection)

    def _publish_errors(self, samples: Sequence[ErrorSample]) -> None:
        for topic in self._subscribed_errors:
            self._outputs.send((topic, self._messages.transmission_error(s)) for s in samples)

    def _note_unsent(self, publisher: Publisher, error: Exception) -> None:
        # For example, with history keep_all and a blocked subscriber.
        self._monitor.unsent += 1
        self._warn(f'{publisher.topic_name} not sent: {error}')

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _warn_of(self, topic: str, rejection: RejectedInputError) -> None:
        others = topic == topics.ROTOR_STATE and JOINT_MISSING not in self._input.rejected
        if str(rejection) == JOINT_MISSING and others:
            return  # a message of another driver on a shared topic
        if time.monotonic() >= self._next_warning:
            detail = f': {rejection.detail}' if rejection.detail else ''
            self._warn(f'{topic} rejected: {rejection}{detail}')

    def _report(self) -> None:
        for driver in self._drivers:
            driver.count_losses()
        self._missing_publisher.update(self._monitor.drivers)
        self._look_at_graph()
        now = time.monotonic()
        errors = self._encoder_monitor.report(self._encoder, self._settings, now)
        rotor = self._monitor.report(self._input, now, self._encoder.reference)
        preload = self._preload.report() if self._preload else None
        reports = {'rotor input': rotor, 'transmission error': errors, 'preload': preload}
        message = serialize_message(diagnostic_array(self, reports))
        self._outputs.send([(topics.DIAGNOSTICS, message)])

    def _look_at_graph(self) -> None:
        """Check the connections with other nodes, and log new faults."""
        known = self._monitor.graph
        inputs = (driver.subscription for driver in self._drivers)
        found = self._monitor.graph = find_faults(
            self, inputs, self._outputs.publishers.values(), exclusive=topics.STATE_TOPICS
        )
        for fault in (*found.errors, *found.warnings):
            if fault not in (*known.errors, *known.warnings):
                self.get_logger().warning(fault)
