# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_state_publisher: parameters, topics and diagnostics; no mathematics."""

import time
import traceback
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from itertools import cycle
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import Bool

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.parameters import NODE, PARAMETERS, NodeParameters
from gear_kinematics.parameters.arm import full_name, labelled, shared_names
from gear_kinematics.parameters.files import require_any
from gear_kinematics.ros.actuator import Actuator
from gear_kinematics.ros.diagnostics import diagnostic_array, find_faults
from gear_kinematics.ros.display import Display
from gear_kinematics.ros.driver_log import DriverLog
from gear_kinematics.ros.drivers import DEPTH, DriverInput
from gear_kinematics.ros.homing import Homing, restored
from gear_kinematics.ros.node_parameters import declared_actuators, fault_of
from gear_kinematics.ros.other_gears import OtherGears
from gear_kinematics.ros.outputs import PublishingNode, latched
from gear_kinematics.state.arm_state import ArmState
from gear_kinematics.state.monitors import Connections
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.state.statuses import GearReport
from gear_kinematics.wire import topics
from gear_kinematics.wire.joint_reader import RejectedInputError, Rejection
from gear_kinematics.wire.topics import topic_of

_REPORT_PERIOD = 1.0  # s
_SHOWN = 'frame_prefix', 'output_joint'  # live parameters in the URDF, which takes 3 ms a gear


class GearStatePublisher(PublishingNode):
    """Publishes the state of its actuators for every valid message on rotor_state."""

    _known = PARAMETERS  # until the names of the actuators are known

    def __init__(self, *, parameter_files: Collection[Path] = (), **options: Any) -> None:
        """Declare the parameters, some of which must be in the files, and open the topics.

        Raises:
            ParameterException: if a parameter is refused.
            ValueError: if the parameters describe no gear, one is unknown, the files have none
                for this node, or the calibration or the home file cannot be used.
        """
        super().__init__(NODE, **options)
        self._files = require_any(parameter_files, self.get_fully_qualified_name())
        self.add_on_set_parameters_callback(self._check_parameters)
        given = declared_actuators(self)
        zeros: Mapping[str, float] = {}
        if home_file := self._file(next(iter(given.values())).home_file):
            home_file = home_file.absolute()
            zeros = restored(self, home_file, given)
        self._actuators: dict[str, Actuator] = {}
        for name, each in given.items():
            homed = replace(each, rotor_zero=zeros.get(name, each.rotor_zero))
            try:
                calibration = self._calibration(each.calibration, each.gear)
                self._actuators[name] = Actuator(homed, calibration)
            except ValueError as error:
                raise ValueError(labelled(name, str(error))) from error
        self._named = {full_name(name, key): (name, key) for name in given for key in PARAMETERS}
        self._known = {full: PARAMETERS[key] for full, (_, key) in self._named.items()}
        self._arm = ArmState({name: each.state for name, each in self._actuators.items()})
        self._referenced: bool | None = None  # as it was published last
        self._connections = Connections()

        self._topics = self._arm.topics
        for topic in self._topics:
            self.open_output(topic, QoSProfile(depth=DEPTH))
        self.note_subscribers()
        for topic in dict.fromkeys(topic_of(name, topics.REFERENCED) for name in ('', *given)):
            self.open_output(topic, latched())
        self.open_output(topics.DIAGNOSTICS, QoSProfile(depth=10))
        self._display: Display | None = None
        if shown := self._shown():
            self._display = Display(self, shown)
            self._display.update(shown)
        self.add_post_set_parameters_callback(self._configure)
        self._homing = Homing(self, home_file, self._actuators, zeros)
        # A missing input must be reported even while a simulated clock is paused. Both checks
        # alternate, because one after the other they would delay more messages.
        checks = cycle((self._look_at_graph, self._report))

        def check() -> None:
            next(checks)()

        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(0.5 * _REPORT_PERIOD, check, clock=steady)
        inputs = {name: each.state.input for name, each in self._actuators.items()}
        self._driver_log = DriverLog(self, inputs, lambda: self._arm.joints)
        self._rotor_driver = DriverInput(
            self,
            topics.ROTOR_STATE,
            self._on_rotor_state,
            self._connections.rotor,
        )
        encoder = self._connections.encoder
        self._drivers = (
            self._rotor_driver,
            DriverInput(self, topics.OUTPUT_ENCODER, self._on_output_encoder, encoder),
        )
        self._other_gears = OtherGears(self, lambda: self._current().values())
        self._log_start()

    def _current(self) -> dict[str, NodeParameters]:
        """Return the parameters of all actuators."""
        return {name: each.state.parameters for name, each in self._actuators.items()}

    def _shown(self) -> dict[str, NodeParameters]:
        """Return the parameters of the actuators whose bodies are known."""
        return {name: each for name, each in self._current().items() if not each.gear_ratio}

    def _log_start(self) -> None:
        """Log which gears there are, and where their rotors are looked up, in one line."""
        texts = []
        for name, each in self._current().items():
            gear, known = each.gear, 'bodies unknown'
            if isinstance(gear, Mechanism):
                known = f'ring {gear.ring_teeth}, satellite {gear.satellite_teeth} teeth'
            if each.rotor_period and not each.absolute:
                known += '; turns unknown until it is homed'
            joint = f'joint {each.rotor_joint!r}' if each.rotor_joint else 'the only joint'
            texts.append(labelled(name, f'{joint}, gear ratio {gear.gear_ratio} ({known})'))
        topic = self._rotor_driver.subscription.topic_name
        self.get_logger().info(f'listening on {topic} for {"; ".join(texts)}')

    def note_subscribers(self, _event: object = None) -> None:
        """Let only the outputs with subscribers be computed."""
        heard = [each for each in self._topics if self.outputs[each].get_subscription_count()]
        self._arm.choose(heard)

    def _check_parameters(self, changed: list[Parameter]) -> SetParametersResult:
        try:
            reason = next(filter(None, (fault_of(each, self._known) for each in changed)), '')
            if not reason and hasattr(self, '_arm'):  # else the constructor checks them
                self._prepare((parameter.name, parameter.value) for parameter in changed)
        except ValueError as error:
            reason = str(error)
        except Exception as error:  # noqa: BLE001, nothing that is set may end the node
            reason = f'unexpected {type(error).__name__}: {error}'
            self.get_logger().error(traceback.format_exc())
        return SetParametersResult(successful=not reason, reason=reason)

    def _prepare(self, changed: Iterable[tuple[str, Any]]) -> None:
        """Prepare what depends on changed parameters and may refuse them, even if set twice."""
        prepared = {
            name: (each.state.parameters, each.state.calibration)
            for name, each in self._actuators.items()
        }
        affected = {''} & prepared.keys()
        for full, value in changed:
            name, key = self._named.get(full, ('', ''))
            if key:
                affected.add(name)
                parameters, calibration = prepared[name]
                parameters = replace(parameters, **{key: value})
                state_messages(parameters)  # to check the names
                if key == 'calibration':
                    calibration = self._calibration(value, parameters.gear)
                prepared[name] = parameters, calibration
        if '' not in prepared:
            faults = shared_names({name: parameters for name, (parameters, _) in prepared.items()})
            if faults:
                raise ValueError('; '.join(faults))
        self._prepared = {name: prepared[name] for name in affected}

    def _calibration(self, value: str, gear: Gear) -> Calibration | None:
        path = self._file(value)
        return Calibration.load(path, gear) if path else None

    def _file(self, value: str) -> Path | None:
        return self._files.get(value, Path(value)) if value else None

    def _configure(self, changed: Collection[Parameter]) -> None:
        """Apply what was prepared, after every change."""
        for name, prepared in self._prepared.items():
            self._arm.apply(name, *prepared)
        named = [self._named.get(parameter.name, ('', '')) for parameter in changed]
        if self._display and any(key in _SHOWN for _, key in named):
            self._display.update(self._shown())
        if homed := [name for name, key in named if key == 'rotor_zero']:
            self._homing.keep(homed)

    def _on_rotor_state(self, data: bytes) -> None:
        answered, rejections = self._arm.rotor(data, self._now)
        for name, rejection in rejections:
            self._warn_of(topics.ROTOR_STATE, name, rejection)
        if not answered:
            return
        now, number = time.monotonic(), self._connections.rotor.number
        changed: dict[str, bool] = {}
        for name, state in answered:
            actuator = self._actuators[name]
            if state.monitor.publishers.note(number):
                self._driver_log.replaced(name, actuator.last)
            actuator.note(now)
            if state.referenced is not actuator.referenced:
                changed[name] = state.referenced
        if self._driver_log.awaited:
            moved = self._driver_log.heard({name: state.sample for name, state in answered})
            for name, angle in moved.items():
                self._actuators[name].state.monitor.moved = angle
        if changed:
            self._publish_referenced(changed)
        self.send(self._arm.encode(answered))
        if self._arm.finds_turns and (found := self._found_turns(answered)):
            self._publish_referenced(found)

    def _found_turns(self, taken: Iterable[tuple[str, object]]) -> dict[str, bool]:
        """Return whether turns are known, for the actuators for which that has changed."""
        found = {}
        for name, _ in taken:
            actuator = self._actuators[name]
            referenced = actuator.state.input.turns.referenced
            if referenced is not actuator.referenced is not None:
                found[name] = referenced
        return found

    def _publish_referenced(self, changed: Mapping[str, bool]) -> None:
        """Publish at once which turns have become known or unknown."""
        known, values = False, {}
        for name, value in changed.items():
            known |= self._actuators[name].referenced is not None
            values[topic_of(name, topics.REFERENCED)] = value
            self._actuators[name].referenced = value
        every = all(each.referenced for each in self._actuators.values())
        if every is not self._referenced:
            values[topics.REFERENCED] = self._referenced = every
        self.send((topic, serialize_message(Bool(data=value))) for topic, value in values.items())
        if known:
            self._publish(self._arm.report(time.monotonic(), self._connections))

    def _on_output_encoder(self, data: bytes) -> None:
        errors, rejections = self._arm.encoder(data, self._now)
        now = time.monotonic()
        for name, _ in errors:
            monitor = self._actuators[name].state.encoder_monitor
            monitor.last_input = now
            monitor.publishers.note(self._connections.encoder.number)
        for name, rejection in rejections:
            self._warn_of(topics.OUTPUT_ENCODER, name, rejection)
        self.send(self._arm.encode_errors(errors))
        if found := self._found_turns(errors):
            self._publish_referenced(found)

    def note_unsent(self, publisher: Publisher, error: Exception) -> None:
        """Count a message that was not sent, as with keep_all and a blocked subscriber."""
        self._connections.unsent += 1
        super().note_unsent(publisher, error)

    def _now(self) -> int:
        return int(self.get_clock().now().nanoseconds)

    def _warn_of(self, topic: str, name: str, rejection: RejectedInputError) -> None:
        state, heard = self._actuators[name].state, self._connections
        source, monitor, driver = (
            (state.input, state.monitor, heard.rotor)
            if topic == topics.ROTOR_STATE
            else (state.output_encoder, state.encoder_monitor, heard.encoder)
        )
        if str(rejection) == Rejection.JOINT_MISSING not in source.rejected:
            return  # a message of another driver on a shared topic, and no input
        monitor.last_input = time.monotonic()
        if monitor.publishers.note(driver.number) and monitor is state.monitor:
            self._driver_log.replaced(name, state.input.last)
        of, detail = f' of {name}' if name else '', rejection.detail
        if str(rejection) == Rejection.JOINT_MISSING:
            detail += f'; set {monitor.joint}'
        # Not one for each actuator: all of an arm can lack the same.
        subject = f'{topic} rejected: {rejection}'
        self._warn(f'{topic}{of} rejected: {rejection}{detail and f": {detail}"}', subject)

    def _report(self) -> None:
        for driver in self._drivers:
            driver.count_losses()
        inputs = [each.state.monitor.last_input for each in self._actuators.values()]
        now, last = time.monotonic(), max(each or 0.0 for each in inputs)
        rotor = self._connections.rotor
        reports = self._arm.report(now, self._connections)
        several = [
            name if monitor is state.monitor else labelled(name, topics.OUTPUT_ENCODER)
            for name, state in self._arm.actuators.items()
            for monitor in (state.monitor, state.encoder_monitor)
            if monitor.several
        ]
        self._driver_log.update(rotor.publishers, now - (last or now), several)
        self._publish(reports)

    def _publish(self, reports: Mapping[str, GearReport]) -> None:
        message = serialize_message(diagnostic_array(self, reports))
        self.send([(topics.DIAGNOSTICS, message)])

    def _look_at_graph(self) -> None:
        """Check the connections with other nodes, and log new faults."""
        inputs = (driver.subscription for driver in self._drivers)
        publishers = self.outputs.values()
        states = [topic for topic, base in self._topics.items() if base in topics.STATE_TOPICS]
        found = find_faults(self, inputs, publishers, states, self._other_gears.clash)
        for fault in found:
            if fault not in self._connections.graph:
                self.get_logger().warning(str(fault))
        self._connections.graph = found
