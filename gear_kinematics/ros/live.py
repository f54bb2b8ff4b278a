# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Runs a node in its own process, as its driver and its recorder.

`Replay` is both; `live_messages` plays a bag into a node and yields its outputs.
"""

import os
import struct
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Self

import rclpy
from geometry_msgs.msg import PoseArray
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState

from gear_kinematics.bag import Bag, DamagedBagError, Message, ReportProgress
from gear_kinematics.bag.roles import Topics, in_namespace
from gear_kinematics.bag.schedule import due_messages, throttled
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.workarounds.executor import make_executor
from gear_kinematics.ros.workarounds.shutdown import shut_down
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.wire.cdr import SECOND, STAMP_BYTES, JointStateTemplate, with_stamp
from gear_kinematics.wire.joint_reader import RejectedInputError
from gear_kinematics.wire.topics import CORRECTED_TOPICS, JOINT_STATE, OUTPUT_ENCODER

POLL = 0.1  # greatest delay of the response to a signal, s

_TOPICS = Topics()
_ENCODER = f'/{OUTPUT_ENCODER}'
_LISTENERS = 2  # to each encoder: the node and the recorder
_PROBE_PERIOD = 0.05  # s
_AFTERWARDS = 0.1  # s to wait for unexpected messages
_WINDOW = 500  # messages by which the node may lag; a queue of DEPTH does not overflow
_STOP_TIMEOUT = 30.0  # s for a node to end; it needs one at most
_MAX_SILENCE = 5.0  # s without messages after which no more are expected; DDS repeats every 3 s
_PROBE_SECOND = 2**31 - 1  # the latest in a stamp
_PROBE_STAMP = struct.pack('<iI', _PROBE_SECOND, 0)


class ReplayError(RuntimeError):
    """A replay failed; the text gives the cause."""


@contextmanager
def running_node(arguments: Sequence[str] = (), **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Run gear_state_publisher as a process with options of `Popen`, and stop it at the end."""
    # Without -P, `-m` would import modules from the current folder.
    command = [sys.executable, '-P', '-m', 'gear_kinematics.ros', *arguments]
    process = subprocess.Popen(command, text=True, **options)  # noqa: S603  # our own node
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(_STOP_TIMEOUT)
        except subprocess.TimeoutExpired:  # as of one that is stopped, or hangs
            process.kill()
            process.wait()


def live_messages(
    source: Bag,
    parameters: NodeParameters,
    *,
    rotor_topic: str = _TOPICS.rotor,
    encoder_topic: str = '',
    rate: float = 1.0,
    progress: ReportProgress = lambda _done, _total: None,
) -> Iterator[Message]:
    """Play a bag's topics of encoders into a node process, and yield all messages as received.

    They are on /rotor_state, /output_encoder and `outputs_of` the parameters. The node runs in a
    private namespace and communicates on this machine only. Messages are sent `rate` times as fast
    as they were recorded, but only as fast as the node processes them, so that none is lost. Rotor
    messages without a stamp get their time of reception: the node would use its clock, and the
    outputs could not be matched. The progress is that of the rotor's messages.

    Raises:
        BagError: if the topic is missing or empty; if the bag is damaged, after the outputs for
            the readable messages.
        ReplayError: if the node ends or never answers.
    """
    expected = GearState(parameters)
    outputs = outputs_of(parameters)
    source.type_of(rotor_topic, JOINT_STATE)
    schedule = due_messages(source, [rotor_topic, *filter(None, [encoder_topic])], rate)
    report = throttled(progress)
    wanted: Counter[str] = Counter()
    damage: DamagedBagError | None = None
    with _private_node(parameters) as replay:
        start = time.monotonic()
        try:
            for due, (topic, received, recorded) in schedule:
                while (left := start + due - time.monotonic()) > 0.0:
                    replay.receive_until(time.monotonic() + min(left, POLL))
                    yield from replay.take()
                data = _stamped(recorded, received)
                sent = _TOPICS.rotor if topic == rotor_topic else _ENCODER
                replay.send(data, sent)
                wanted[sent] += 1
                if sent == _TOPICS.rotor:
                    with suppress(RejectedInputError):
                        expected.rotor(data, partial(int, received))
                        wanted.update(outputs)
                if not replay.receive(wanted, but=_WINDOW):
                    wanted = replay.counts.copy()  # missing messages will not come any more
                report(expected.input.received, None)
                yield from replay.take()
        except DamagedBagError as error:
            damage = error
        replay.receive(wanted)
        replay.receive_until(time.monotonic() + _AFTERWARDS)
        yield from replay.take()
    progress(expected.input.received, None)
    if damage:
        raise damage


class Replay:
    """A driver of both encoders, and a recorder of their messages and of the node's outputs.

    A context manager with its own ROS context. Messages are received only within its methods that
    wait; nothing runs in the background.
    """

    def __init__(
        self,
        namespace: str = '',
        alive: Callable[[], bool] = lambda: True,
        outputs: Collection[str] = _TOPICS[1:],
    ) -> None:
        """Open the topics in a namespace; `alive` returns whether the node can still answer."""
        self.received: list[Message] = []
        self.counts: Counter[str] = Counter()  # numbers of messages received so far, by topic
        self._alive = alive
        self._probed: set[str] = set()
        self._resources = ExitStack()
        self._node = self._resources.enter_context(replay_node(namespace))
        self._executor = make_executor(context=self._node.context)
        self._resources.callback(self._executor.shutdown)
        self._executor.add_node(self._node)
        qos = QoSProfile(depth=DEPTH)
        self._publishers = {
            topic: self._node.create_publisher(JointState, topic[1:], qos)
            for topic in (_TOPICS.rotor, _ENCODER)
        }
        self._topics = {_TOPICS.rotor, *outputs}
        for topic in self._topics | {_ENCODER}:
            message_type = PoseArray if topic == _TOPICS.poses else JointState
            self._node.create_subscription(
                message_type, topic[1:], self._recorder(topic), qos, raw=True
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._resources.close()

    def wait_for_node(self, joint: str, timeout: float = 60.0) -> None:
        """Wait until probes are answered, since discovery on this side does not suffice.

        The probes have a stamp in the far future and are not recorded; the node restarts at the
        older stamps after them. ReplayError is raised if there is no answer in time (s).
        """
        template = JointStateTemplate([joint or 'rotor'], velocity=False, effort=False)
        message = template.encode(_PROBE_SECOND * SECOND, [0.0])
        deadline = time.monotonic() + timeout
        drivers = self._publishers.values()
        while self._probed != self._topics or any(
            driver.get_subscription_count() < _LISTENERS for driver in drivers
        ):
            if time.monotonic() > deadline:
                raise ReplayError(f'the node did not answer within {timeout:g} s')
            self.send(message)
            self.receive_until(time.monotonic() + _PROBE_PERIOD)

    def receive_until(self, moment: float) -> None:
        """Receive until a moment of `time.monotonic()`; raises ReplayError if the node ends."""
        while (left := moment - time.monotonic()) > 0.0:
            self._spin(min(left, POLL))

    def send(self, data: bytes, topic: str = _TOPICS.rotor) -> None:
        """Send a serialised JointState of the rotor, or on another topic of an encoder."""
        self._publishers[topic].publish(data)

    def take(self) -> list[Message]:
        """Remove and return the messages in `received`."""
        taken, self.received = self.received, []
        return taken

    def receive(self, wanted: Counter[str], but: int = 0) -> bool:
        """Receive until no topic lacks more than `but` of its wanted messages, from the start.

        Returns False after some seconds without any message; raises ReplayError if the node ends.
        """
        total, deadline = -1, 0.0
        while max((wanted - self.counts).values(), default=0) > but:
            now = time.monotonic()
            if self.counts.total() > total:
                total, deadline = self.counts.total(), now + _MAX_SILENCE
            if now > deadline:
                return False
            self._spin(POLL)
        return True

    def _spin(self, timeout: float) -> None:
        """Receive a message; no signal interrupts it."""
        if not self._alive():
            raise ReplayError('the node has ended')
        self._executor.spin_once(timeout_sec=timeout)

    def _recorder(self, topic: str) -> Callable[[bytes], None]:
        def record(data: bytes) -> None:
            if data[STAMP_BYTES] == _PROBE_STAMP:
                self._probed.add(topic)
                return
            self.counts[topic] += 1
            self.received.append((topic, time.time_ns(), data))

        return record


@contextmanager
def replay_node(namespace: str, name: str = 'gear_kinematics_replay') -> Iterator[Node]:
    """Create a ROS node in its own context, without signal handlers and services."""
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node(
        name,
        context=context,
        namespace=namespace,
        start_parameter_services=False,
        parameter_overrides=[Parameter('start_type_description_service', value=False)],
    )
    try:
        yield node
    finally:
        shut_down(node)


@contextmanager
def _private_node(parameters: NodeParameters) -> Iterator[Replay]:
    """Run a node process that is isolated from all others, and connect to it."""
    # The middleware reads these when a context is created, here and in the node's process.
    private = {
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST',
        'SKIP_DEFAULT_XML_FILE': '1',  # Fast DDS would read one in the current folder
    }
    namespace = f'/gear_kinematics_{os.getpid()}'
    with TemporaryDirectory() as folder:
        config, log = Path(folder, 'parameters.yaml'), Path(folder, 'log')
        if path := parameters.calibration:  # a relative one would be relative to `config`
            parameters = replace(parameters, calibration=str(Path(path).absolute()))
        # The zero is that of the parameters, and every input is to be answered.
        parameters = replace(parameters, home_file='', unreferenced_outputs='publish')
        config.write_text(parameters.as_file(), 'utf-8')
        # The topic of diagnostics has an absolute name.
        arguments = ['--ros-args', '-r', f'__ns:={namespace}', '--params-file', str(config),
                     '-r', '/diagnostics:=diagnostics']  # fmt: skip
        with (
            _environment(private),
            log.open('w', encoding='utf-8') as stream,
            running_node(
                arguments, stdout=stream, stderr=stream, env=os.environ | {'ROS_LOG_DIR': folder}
            ) as process,
            Replay(
                namespace, alive=lambda: process.poll() is None, outputs=outputs_of(parameters)
            ) as replay,
        ):
            try:
                replay.wait_for_node(parameters.rotor_joint)
                yield replay
            except ReplayError as error:
                words = log.read_text(encoding='utf-8').splitlines()[-1:]
                raise ReplayError(': '.join([str(error), *words])) from error


@contextmanager
def _environment(values: Mapping[str, str]) -> Iterator[None]:
    """Set variables of the environment, and restore it at the end."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def outputs_of(parameters: NodeParameters) -> Collection[str]:
    """Return the recorded topics on which the node answers."""
    outputs = [_TOPICS.output]
    if isinstance(parameters.gear, Mechanism):
        outputs.append(_TOPICS.poses)
    if parameters.calibration:
        outputs += in_namespace(CORRECTED_TOPICS).values()
    return outputs


def _stamped(data: bytes, received: int) -> bytes:
    """Return the message, with its time of reception as stamp if it has none."""
    if any(data[STAMP_BYTES]) or len(data) < STAMP_BYTES.stop:
        return data
    return with_stamp(data, received)
