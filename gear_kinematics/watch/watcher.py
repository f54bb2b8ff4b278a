# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Watches the node of a gear and the drivers beside it, in a thread of its own."""

import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import replace
from queue import SimpleQueue
from threading import Event
from typing import Any, Self

from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

from gear_kinematics.kinematics import GearRatio, Mechanism
from gear_kinematics.measurement.commissioning.analysis import Request
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.commissioning import LiveCommissioning
from gear_kinematics.watch.drivers import Drivers, Graph
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.view import Answer, View, view_of

PERIOD = 1.0 / 30.0
"""s between two looks at the messages."""
_LOOK = 0.5  # s between two looks at the graph
_ANSWER = 5.0  # s to wait for the answer of a service


class Watcher:
    """A context manager; everything of ROS happens in its thread.

    It watches a node, or the first that runs.
    """

    def __init__(self, node: str = '') -> None:
        self.view = View()
        self.drawn: tuple[Mechanism | None, float] = None, 0.0
        """The mechanism, if more than its ratio is known, and the module of its teeth, m."""
        self._wanted = node and f'/{node.removeprefix("/")}'
        self._tasks: SimpleQueue[Callable[[], None]] = SimpleQueue()
        self._ending = Event()
        self._ready: Future[None] = Future()
        self._gear: GearNode | None = None
        self._live: LiveCommissioning | None = None
        self._asked: list[Callable[[], bool]] = []  # whether the node's answer is awaited

    def __enter__(self) -> Self:
        """Join ROS; raises whatever prevents that."""
        self._running = ThreadPoolExecutor(1).submit(self._run)
        wait((self._ready, self._running), return_when=FIRST_COMPLETED)
        if self.ended:
            self._running.result()
        return self

    def __exit__(self, *_: object) -> None:
        """Leave ROS; raises whatever has ended it before."""
        self._ending.set()
        self._running.result()

    @property
    def ended(self) -> bool:
        """Whether it watches no more."""
        return self._running.done()

    def ask(self, command: str) -> 'Future[Answer]':
        """Do home or undo, or one of the steps zero_here, write, take and end of commissioning."""
        return self._do(lambda answer: self._command(command, answer))

    def commission(self, request: Request, ratio: str) -> 'Future[Answer]':
        """Begin to hear the joints of a gear, or give another ratio, or '' for none."""
        return self._do(lambda _: self._commission(request, ratio.strip()))

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
        with replay_node('') as self._node:
            executor = SingleThreadedExecutor(context=self._node.context)
            executor.add_node(self._node)
            self._drivers = Drivers(self._node)
            self._ready.set_result(None)
            try:
                self._watch(executor)
            finally:
                self._end()
                executor.shutdown()

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
                self._look(Graph(self._node))
            self._asked = [pending for pending in self._asked if pending()]
            try:
                if self._live:
                    self._live.poll()
                view = self._see()
            except Exception as error:  # noqa: BLE001, a message that no one expected ends nothing
                message = f'What came cannot be shown: {type(error).__name__}: {error}'
                view = View(state='fault', tone='fail', message=message)
            commission = self._live.shown if self._live else None
            drivers = tuple(self._drivers.found())
            self.view = replace(view, drivers=drivers, commission=commission)

    def _look(self, graph: Graph) -> None:
        self._drivers.look(graph.drivers())
        wanted = [self._wanted] if self._wanted else graph.gears
        if wanted and not (self._gear and (self._gear.running or self._gear.name in wanted)):
            self._gear = GearNode(self._node, wanted[0])
        if self._gear:
            self._gear.look(graph)

    def _see(self) -> View:
        if not (gear := self._gear):
            return view_of(None)
        gear.poll()
        drawn = gear.gear if isinstance(gear.gear, Mechanism) else None
        self.drawn = drawn, gear.parameters.module if gear.parameters else 0.0
        return view_of(gear)

    def _running_gear(self) -> GearNode:
        """The node; raises ValueError if none is ready."""
        if not (self._gear and self._gear.running and self._gear.home.service_is_ready()):
            raise ValueError('There is no node that is ready.')
        return self._gear

    def _command(self, command: str, answer: 'Future[Answer]') -> Answer | None:
        live = self._live
        if command == 'home':
            gear = self._running_gear()
            self._await(gear, gear.home.call_async(Trigger.Request()), answer)
        elif command == 'undo':
            if not (words := self.view.undo):
                raise ValueError('There is no change to undo.')
            gear = self._running_gear()
            self._await(gear, gear.set(gear.earlier), answer, f'Undone: {words} again.')
        elif not live:
            raise ValueError('Choose the joints first.')
        elif command == 'take':
            gear = self._running_gear()
            values = live.changes(gear)
            words = f'{gear.name} has taken {", ".join(values)}, until it ends'
            self._await(gear, gear.set(values), answer, f'{words}; the file keeps them.')
        elif command == 'end':
            self._end()
            return Answer('', done=True)
        else:
            return live.write() if command == 'write' else live.zero_here()
        return None

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

    def _end(self) -> None:
        if self._live:
            self._live.close()
        self._live = None


def _told(answered: Any, done: str) -> Answer:
    """What a node answers to Home, or what is done if it has set parameters."""
    if not done:
        return Answer(f'{answered.message}.', answered.success)
    result = answered.result
    return Answer(done if result.successful else f'{result.reason}.', result.successful)
