# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Watches the node of a gear and the drivers beside it, in a thread of its own."""

import shlex
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import Any, Self

from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import GearRatio, Mechanism
from gear_kinematics.measurement.commissioning.analysis import Request
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.parameters.new_config import new_config, unused_name, write_new
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch import graph
from gear_kinematics.watch.commissioning import LiveCommissioning, written
from gear_kinematics.watch.drivers import Driver, Drivers
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.recording import RECORDED_TYPES, Recording
from gear_kinematics.watch.view import Answer, View, state_of, view_of
from gear_kinematics.wire import topics

PERIOD = 1.0 / 30.0
"""s between two looks at the messages."""
_LOOK = 0.5  # s between two looks at the graph
_ANSWER = 5.0  # s to wait for the answer of a service

_NOT_RECORDED = (topics.JOINT_STATES,)  # the same as output_state and body_poses, in other words


class Watcher:
    """A context manager; everything of ROS happens in its thread.

    It watches a node, or the first that runs, and records to a folder as soon as there is one.
    """

    def __init__(self, node: str = '', record: Path | None = None) -> None:
        self.view = View()
        self.drawn: Mechanism | None = None  # of the node, if more than its ratio is known
        self.module = 0.0  # of its teeth, m
        self.exit_message = ''  # what became of the recording, if any
        self.ended = False  # also by itself
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
        self._live: LiveCommissioning | None = None
        self._asked: list[Callable[[], bool]] = []  # whether the node's answer is awaited
        self._drawing = 0
        self._failed = 'Recording begins as soon as there is a node.' if record else ''
        self._found: tuple[Driver, ...] = ()

    def __enter__(self) -> Self:
        """Join ROS; raises whatever prevents that."""
        self._thread.start()
        self._ready.result()
        return self

    def __exit__(self, *_: object) -> None:
        """Finish a recording, and leave ROS; raises whatever has ended it before."""
        self._ending.set()
        self._thread.join()
        if self._error:
            raise self._error

    def home(self) -> 'Future[Answer]':
        """Call ~/home of the node."""
        return self._do(self._home)

    def undo(self) -> 'Future[Answer]':
        """Set parameters of the node to what they were before their last change."""
        return self._do(self._undo)

    def record(self, path: Path | None = None) -> 'Future[Answer]':
        """Begin to record to a folder, by default to a new one in the working directory."""
        return self._do(lambda _: self._record(path))

    def stop(self) -> 'Future[Answer]':
        """End the recording."""
        return self._do(lambda _: self._stop())

    def configure(self, topic: str, joint: str) -> 'Future[Answer]':
        """Write a parameter file for the joint of a driver into the working directory."""
        return self._do(lambda _: self._configure(topic, joint))

    def commission(self, request: Request, ratio: str) -> 'Future[Answer]':
        """Begin to hear the joints of a gear, or give another ratio, or '' for none."""
        return self._do(lambda _: self._commission(request, ratio.strip()))

    def commissioning(self, step: str) -> 'Future[Answer]':
        """Do one of the steps zero_here, write, take and end."""
        return self._do(lambda answer: self._step(step, answer))

    def _do(self, task: Callable[['Future[Answer]'], Answer | None]) -> 'Future[Answer]':
        """Do a task in the thread of ROS; it answers, or keeps the future for later."""
        answer: Future[Answer] = Future()
        answer.set_running_or_notify_cancel()  # whoever waits cannot cancel it

        def run() -> None:
            try:
                if told := task(answer):
                    answer.set_result(told)
            except ValueError as error:
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
                    self._end()
                    if self._recording:
                        self.exit_message = str(self._stop())
                    elif self._to_record:
                        self.exit_message = 'Nothing was recorded: there was no node.'
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
                self._tasks.get()()
            self._drivers.poll()
            if end >= next_look:
                next_look = end + _LOOK
                self._look()
            self._asked = [pending for pending in self._asked if pending()]
            if self._recording and self._recording.status().error:
                self._failed = str(self._stop())
            try:
                if live := self._live:
                    live.poll()
                if self._gear:
                    self._gear.poll()
                view = self._see()
            except Exception as error:  # noqa: BLE001, a message that no one expected ends nothing
                message = f'What came cannot be shown: {type(error).__name__}: {error}'
                view = View(state='fault', tone='fail', message=message)
            if self._recording:
                recorded = self._recording.status()
                about = f'{recorded.path}: {recorded.seconds:.1f} s, {recorded}'
                view = replace(view, recording=about, question='', undo='')
            shown = live.shown if live else None
            self.view = replace(view, drivers=self._found, failure=self._failed, commission=shown)

    def _look(self) -> None:
        """Look at the graph."""
        gears = graph.gear_nodes(self._node)
        self._drivers.look(gears)
        self._found = tuple(self._drivers.found())
        if self._gear:
            self._gear.look()
        wanted = [self._wanted] if self._wanted else gears
        if wanted and not (self._gear and (self._gear.running or self._gear.name in wanted)):
            self._gear = GearNode(self._node, wanted[0])
            self._gear.look()
        self._others = [name for name in gears if self._gear and name != self._gear.name]
        gear = self._gear
        if self._recording and not (gear and gear.restarts >= 0 and not gear.running):
            self._record_topics(self._recording)
        # By its first diagnostics, the drivers have been discovered.
        if self._to_record and gear and gear.statuses and (gear.known or gear.fault):
            path, self._to_record = self._to_record, None
            try:
                self._record(path)
            except ValueError as error:
                self._failed = str(error)

    def _see(self) -> View:
        if not (gear := self._gear):
            return View(**state_of(None, None, ()))
        rotor = self._drivers.latest(gear.inputs.get(topics.ROTOR_STATE))
        # Of a node that was asked for, the others are of no interest once it runs.
        others = self._others if not self._wanted or gear.restarts < 0 else ()
        drawn = gear.gear if isinstance(gear.gear, Mechanism) else None
        module = gear.parameters.module if gear.parameters else 0.0
        if (drawn, module) != (self.drawn, self.module):
            self.drawn, self.module = drawn, module
            self._drawing += 1
        return replace(view_of(gear, rotor, others), gear=self._drawing)

    def _home(self, answer: 'Future[Answer]') -> None:
        gear = self._changeable()
        self._await(gear, gear.home.call_async(Trigger.Request()), answer)

    def _undo(self, answer: 'Future[Answer]') -> None:
        if not (words := self.view.undo):
            raise ValueError('There is no change to undo.')
        gear = self._changeable()
        self._await(gear, gear.set(gear.earlier), answer, f'Undone: {words} again.')

    def _changeable(self) -> GearNode:
        """The node; raises ValueError if its parameters cannot be changed now."""
        gear = self._gear
        if self._recording:
            raise ValueError('Stop the recording first: the outputs would jump within it.')
        if not (gear and gear.running and gear.home.service_is_ready()):
            raise ValueError('There is no node.')
        return gear

    def _await(self, gear: GearNode, asked: Any, answer: 'Future[Answer]', done: str = '') -> None:
        """Answer when the node has homed, or what is done when it has set parameters."""
        deadline = time.monotonic() + _ANSWER

        def pending() -> bool:
            if asked.done():
                answer.set_result(_told(asked.result(), done))
                gear.reread()
            elif time.monotonic() > deadline:
                answer.set_result(Answer('The node does not answer.', done=False))
            return not answer.done()

        self._asked.append(pending)

    def _commission(self, request: Request, ratio: str) -> Answer:
        """Hear two joints; if these are heard already, only the ratio is another one."""
        request = replace(request, ratio=GearRatio.parse(ratio) if ratio else None)
        if request.rotor == request.output:
            raise ValueError('Choose two joints: that of the rotor and that of the output.')
        live = self._live
        if live and (live.request.rotor, live.request.output) == (request.rotor, request.output):
            live.request = replace(live.request, ratio=request.ratio)
        else:
            self._end()
            self._live = LiveCommissioning(self._node, request)
        return Answer('', done=True)

    def _step(self, step: str, answer: 'Future[Answer]') -> Answer | None:
        if not (live := self._live):
            raise ValueError('Choose the joints first.')
        if step == 'take':
            gear = self._changeable()
            values = live.changes(gear)
            words = f'{gear.name} has taken {", ".join(values)}, until it ends'
            self._await(gear, gear.set(values), answer, f'{words}; the file keeps them.')
            return None
        if step == 'end':
            self._end()
            return Answer('', done=True)
        return live.write() if step == 'write' else live.zero_here()

    def _end(self) -> None:
        if self._live:
            self._live.close()
        self._live = None

    def _record(self, path: Path | None) -> Answer:
        if self._recording:
            raise ValueError(f'{self._recording.path} is being recorded.')
        if not self._topics():
            raise ValueError('There is nothing to record.')
        now = datetime.now().astimezone()
        path = path or unused_name(Path(), f'{now:gearkin_%Y-%m-%d_%H-%M-%S}')
        recording = Recording(path)
        self._record_topics(recording)
        self._recording, self._failed = recording, ''
        words = f'Recording {len(recording.status().counts)} topics.'
        if self._gear and self._gear.known and self._gear.parameters:
            words += _keep_parameters(self._gear.parameters, path)
        return Answer(words, done=True)

    def _record_topics(self, recording: Recording) -> None:
        """Record the topics that there are now, with those that have appeared."""
        found, answers = self._topics(), {}
        if self._gear and (rotor := self._gear.inputs.get(topics.ROTOR_STATE)):
            states = {self._gear.outputs.get(name, '') for name in topics.STATE_TOPICS}
            answers = dict.fromkeys(states & found.keys(), rotor)
        recording.add(self._node, found, answers)

    def _topics(self) -> dict[str, str]:
        """The topics to record: of the node with those that it hears, or else of all drivers."""
        if not (self._gear and self._gear.running):
            return dict.fromkeys((driver.topic for driver in self._found), topics.JOINT_STATE)
        # A subscription adapts to the publishers that there are.
        heard = [topic for topic in self._gear.heard if self._node.count_publishers(topic)]
        return dict.fromkeys(heard, topics.JOINT_STATE) | {
            topic: topics.TOPICS[name].type
            for name, topic in self._gear.outputs.items()
            if topics.TOPICS[name].type in RECORDED_TYPES and name not in _NOT_RECORDED
        }

    def _stop(self) -> Answer:
        if not self._recording:
            raise ValueError('Nothing is being recorded.')
        recorded = self._recording.stop()
        self._recording = None
        if recorded.error:
            return Answer(f'The recording has ended: {recorded.error}', done=False)
        heard = self._gear.heard if self._gear else ()
        silent = [topic for topic in heard if not recorded.counts.get(topic)]
        missing = f'; nothing came on {", ".join(silent)}' if silent else ''
        job = 'validate' if self._gear else 'commission'  # there are no outputs without a node
        command = f'gearkin {job} {shlex.quote(str(recorded.path))}'
        return Answer(f'Recorded {recorded}{missing}:', done=True, command=command)

    def _configure(self, topic: str, joint: str) -> Answer:
        if not any(driver.topic == topic and joint in driver.joints for driver in self._found):
            raise ValueError(f'There is no joint {joint} on {topic}.')
        return written(lambda name: new_config(topic, joint, name), topic)


def _told(answered: Any, done: str) -> Answer:
    """What a node answers to Home, or what is done if it has set parameters."""
    if not done:
        return Answer(f'{answered.message}.', answered.success)
    result = answered.result
    return Answer(done if result.successful else f'{result.reason}.', result.successful)


def _keep_parameters(parameters: NodeParameters, folder: Path) -> str:
    """Write the parameters beside the data, where `gearkin validate` looks for them."""
    note, calibration = '', parameters.calibration
    if calibration and not Path(calibration).is_absolute():
        note = f' Give its calibration to gearkin validate: {calibration}.'
        parameters = replace(parameters, calibration='')
    parameters = replace(parameters, home_file='')  # the zero is in them
    write_new(folder / default_config().name, parameters.as_file())
    return note
