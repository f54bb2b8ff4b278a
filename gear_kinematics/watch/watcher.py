"""Watches the node of a gear and the drivers beside it, in a thread of its own."""

import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event, Thread
from types import MappingProxyType
from typing import Any, NamedTuple, Self

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future as RosFuture
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gear_kinematics.bag import BagError
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.new_config import new_config, start_command, unused_name, write_new
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch import graph
from gear_kinematics.watch.drivers import Driver, Drivers
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.recording import Recording
from gear_kinematics.watch.view import (
    View,
    motion_of,
    readings_of,
    recording_in_words,
    sentences_of,
    state_of,
)
from gear_kinematics.wire import topics

PERIOD = 1.0 / 30.0
"""s between two looks at the messages."""
_LOOK = 0.5  # s between two looks at the graph
_ANSWER = 5.0  # s to wait for the answer of a service

_CLASSES: Mapping[str, type] = MappingProxyType(
    {
        topics.JOINT_STATE: JointState,
        topics.POSE_ARRAY: PoseArray,
        topics.TOPICS[topics.DIAGNOSTICS].type: DiagnosticArray,
    }
)
_NOT_RECORDED = (topics.JOINT_STATES,)  # the same as output_state and body_poses, in other words


class Answer(NamedTuple):
    """What came of a command."""

    text: str
    done: bool


class _Homing(NamedTuple):
    """A call of ~/home without an answer."""

    gear: GearNode
    asked: RosFuture
    deadline: float
    """s of a steady clock."""
    answer: 'Future[Answer]'

    def settled(self) -> bool:
        """Pass on the answer, or that there is none; returns whether this is done."""
        if self.asked.done():
            result, before = self.asked.result(), self.gear.parameters
            was = f'; it was {before.rotor_zero} rad' if result.success and before else ''
            self.answer.set_result(Answer(f'{result.message}{was}.', result.success))
            self.gear.reread()
        elif time.monotonic() > self.deadline:
            self.answer.set_result(Answer('The node does not answer.', done=False))
        return self.answer.done()


class Watcher:
    """A context manager; everything of ROS happens in its thread."""

    def __init__(self, node: str = '', record: Path | None = None) -> None:
        """Define what to watch.

        Args:
            node: full name of the node of a gear; '' takes the first that runs.
            record: folder to record to as soon as there is a node.
        """
        self.view = View()
        self.drawn: Mechanism | None = None
        """The mechanism of the node, if more than its ratio is known."""
        self.module = 0.0
        """Of its teeth, m."""
        self.farewell = ''
        """What became of the recording, if any, at the end."""
        self.ended = False
        """Whether it has ended, also by itself."""
        self._error: Exception | None = None
        self._to_record = record
        self._wanted = node and f'/{node.removeprefix("/")}'
        self._tasks: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._ending = Event()
        self._ready: Future[None] = Future()
        self._thread = Thread(target=self._run)
        self._gear: GearNode | None = None
        self._others: list[str] = []
        self._recording: Recording | None = None
        self._homings: list[_Homing] = []
        self._drawing = 0
        self._failed = ''
        self._found: tuple[Driver, ...] = ()

    def __enter__(self) -> Self:
        """Join ROS.

        Raises:
            Exception: whatever prevents that.
        """
        self._thread.start()
        self._ready.result()
        return self

    def __exit__(self, *_: object) -> None:
        """Finish a recording, and leave ROS.

        Raises:
            Exception: whatever has ended it before.
        """
        self._ending.set()
        self._thread.join()
        if self._error:
            raise self._error

    def home(self) -> 'Future[Answer]':
        """Call ~/home of the node."""
        answer: Future[Answer] = Future()

        def refuse(reason: str) -> None:
            answer.set_result(Answer(reason, done=False))

        def begin() -> None:
            gear = self._gear
            if self._recording:
                refuse('Stop the recording first: Home would move the zero within it.')
            elif not (gear and gear.running and gear.home.service_is_ready()):
                refuse('There is no node to home.')
            else:
                asked = gear.home.call_async(Trigger.Request())
                self._homings.append(_Homing(gear, asked, time.monotonic() + _ANSWER, answer))

        self._tasks.put(begin)
        return answer

    def record(self, path: Path | None = None) -> 'Future[Answer]':
        """Begin to record to a folder, by default to a new one in the working directory."""
        return self._do(lambda: self._record(path))

    def stop(self) -> 'Future[Answer]':
        """End the recording."""
        return self._do(self._stop)

    def configure(self, topic: str, joint: str) -> 'Future[Answer]':
        """Write a parameter file for the joint of a driver into the working directory."""
        return self._do(lambda: self._configure(topic, joint))

    def _do(self, task: Callable[[], Answer]) -> 'Future[Answer]':
        answer: Future[Answer] = Future()

        def run() -> None:
            try:
                answer.set_result(task())
            except (BagError, ConfigError) as error:
                answer.set_result(Answer(str(error), done=False))

        self._tasks.put(run)
        return answer

    def _run(self) -> None:
        try:
            with replay_node('') as self._node:
                executor = SingleThreadedExecutor(context=self._node.context)
                executor.add_node(self._node)
                self._drivers = Drivers(self._node)
                self._ready.set_result(None)
                try:
                    self._watch(executor)
                finally:
                    if self._recording:
                        self.farewell = self._stop().text
                    executor.shutdown()
        except Exception as error:  # noqa: BLE001, raised again in the thread that waits
            if self._ready.done():
                self._error = error
            else:
                self._ready.set_exception(error)
        finally:
            self.ended = True

    def _watch(self, executor: SingleThreadedExecutor) -> None:
        next_look = 0.0
        while not self._ending.is_set():
            end = time.monotonic() + PERIOD
            while (left := end - time.monotonic()) > 0.0:
                executor.spin_once(timeout_sec=left)
            while not self._tasks.empty():
                with suppress(Empty):
                    self._tasks.get_nowait()()
            look = end >= next_look
            if look:
                next_look = end + _LOOK
                self._look()
            self._drivers.poll()
            if self._gear:
                self._gear.poll()
            if look:
                self._found = tuple(self._drivers.found())
            # By its first diagnostics, the drivers have been discovered.
            if self._to_record and self._gear and self._gear.known and self._gear.statuses:
                self._failed = self._record_from_start(self._to_record)
                self._to_record = None
            self._homings = [homing for homing in self._homings if not homing.settled()]
            if self._recording and self._recording.status().error:
                self._failed = self._stop().text
            self.view = self._see()

    def _look(self) -> None:
        """Look at the graph."""
        gears = graph.gear_nodes(self._node)
        self._drivers.look(gears)
        if self._gear:
            self._gear.look()
        wanted = [self._wanted] if self._wanted else gears
        if wanted and not (self._gear and (self._gear.running or self._gear.name in wanted)):
            self._gear = GearNode(self._node, wanted[0])
            self._gear.look()
        self._others = [name for name in gears if self._gear and name != self._gear.name]

    def _see(self) -> View:
        gear = self._gear
        shown: dict[str, Any] = state_of(gear, () if self._wanted else self._others)
        if gear:
            rotor = self._drivers.latest(gear.inputs.get(topics.ROTOR_STATE))
            shown |= motion_of(gear)
            shown['readings'] = tuple(readings_of(gear, rotor))
            shown['sentences'] = tuple(sentences_of(gear))
            self._draw(gear)
            shown['gear'] = self._drawing
        if self._recording:
            shown['recording'] = recording_in_words(self._recording.status())
        elif self._failed:
            shown['failure'] = self._failed
        return View(drivers=self._found, **shown)

    def _draw(self, gear: GearNode) -> None:
        """Note which mechanism there is to draw."""
        drawn = gear.gear if isinstance(gear.gear, Mechanism) else None
        module = gear.parameters.module if gear.parameters else 0.0
        if (drawn, module) != (self.drawn, self.module):
            self.drawn, self.module = drawn, module
            self._drawing += 1

    def _record(self, path: Path | None) -> Answer:
        if self._recording:
            return Answer(f'{self._recording.path} is being recorded.', done=False)
        found = self._topics()
        if not found:
            return Answer('There is nothing to record.', done=False)
        now = datetime.now().astimezone()
        path = path or unused_name(Path(), f'{now:gearkin_%Y-%m-%d_%H-%M-%S}')
        types = {topic: (kind, _CLASSES[kind]) for topic, kind in found.items()}
        self._recording = Recording(self._node, types, path, self._answers(found))
        self._failed = ''
        words = f'Recording {len(found)} topics.'
        if self._gear and self._gear.running and self._gear.known and self._gear.parameters:
            words += _keep_parameters(self._gear.parameters, path)
        return Answer(words, done=True)

    def _record_from_start(self, path: Path) -> str:
        try:
            self._record(path)
        except (BagError, ConfigError) as error:
            return str(error)
        return ''

    def _topics(self) -> dict[str, str]:
        """The topics to record: of the node with those that it hears, or else of all drivers."""
        drivers = [driver.topic for driver in self._found]
        if not (self._gear and self._gear.running):
            return dict.fromkeys(drivers, topics.JOINT_STATE)
        encoder = self._gear.inputs.get(topics.OUTPUT_ENCODER)  # optional
        heard = [topic for topic in self._gear.heard if topic != encoder or topic in drivers]
        return dict.fromkeys(heard, topics.JOINT_STATE) | {
            topic: topics.TOPICS[name].type
            for name, topic in self._gear.outputs.items()
            if topics.TOPICS[name].type in _CLASSES and name not in _NOT_RECORDED
        }

    def _answers(self, found: Mapping[str, str]) -> dict[str, str]:
        """The topics of the state among some topics, with that of the rotor, if it is known."""
        if not (self._gear and topics.ROTOR_STATE in self._gear.inputs):
            return {}
        states = {self._gear.outputs.get(name, '') for name in topics.STATE_TOPICS}
        return dict.fromkeys(states & found.keys(), self._gear.inputs[topics.ROTOR_STATE])

    def _stop(self) -> Answer:
        if not self._recording:
            return Answer('Nothing is being recorded.', done=False)
        recorded = self._recording.stop()
        self._recording = None
        if recorded.error:
            return Answer(f'The recording has ended: {recorded.error}', done=False)
        lost = 'losses not counted' if recorded.lost is None else f'{recorded.lost} lost'
        return Answer(
            f'Recorded {recorded.messages} messages, {lost}: gearkin validate {recorded.path}',
            done=True,
        )

    def _configure(self, topic: str, joint: str) -> Answer:
        known = any(driver.topic == topic and joint in driver.joints for driver in self._found)
        if not known:
            return Answer(f'There is no joint {joint} on {topic}.', done=False)
        path = unused_name(Path(), default_config().name)
        write_new(path, new_config(topic, joint, path.name))
        return Answer(f'{path} is written. Start: {start_command(topic, path.name)}', done=True)


def _keep_parameters(parameters: NodeParameters, folder: Path) -> str:
    """Write the parameters beside the data, where `gearkin validate` looks for them."""
    note, calibration = '', parameters.calibration
    if calibration and not Path(calibration).is_absolute():
        note = f' Give its calibration to gearkin validate: {calibration}.'
        parameters = replace(parameters, calibration='')
    write_new(folder / default_config().name, parameters.as_file())
    return note
