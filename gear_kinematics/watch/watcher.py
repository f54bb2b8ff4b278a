# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Watches a gear node and the drivers, in a separate thread."""

import time
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from queue import SimpleQueue
from threading import Event
from typing import Any, Self

from rclpy.executors import SingleThreadedExecutor

from gear_kinematics.kinematics import GearRatio, Mechanism
from gear_kinematics.measurement.commissioning.analysis import Channel, Request
from gear_kinematics.ros.graph import Graph
from gear_kinematics.ros.live import replay_node
from gear_kinematics.watch.commissioning import LiveCommissioning
from gear_kinematics.watch.drivers import Listener
from gear_kinematics.watch.gear import Answer, GearNode
from gear_kinematics.watch.view import View, driver_entry, view_of

PERIOD = 1.0 / 30.0  # period at which messages are taken, s
_LOOK = 0.5  # s between two looks at the graph
_SEARCH = 4.0  # s, in which nodes are found that announce themselves every 3 s


class Watcher:
    """A context manager that watches a node, or the first that runs, in a separate thread."""

    def __init__(self, node: str = '', actuator: str = '') -> None:
        self.view = view_of(None, looking=True)
        self.drawn: tuple[Mechanism | None, float] = None, 0.0
        """The mechanism, if more than its ratio is known, and the module of its teeth, m."""
        self._wanted = f'/{node.removeprefix("/")} {actuator}'.rstrip() if node else ''
        self._actuator = actuator  # of the first node that runs
        self._asked: SimpleQueue[tuple[Any, Future[Answer]]] = SimpleQueue()
        self._ending = Event()
        self._gear: GearNode | None = None
        self._gears: list[GearNode] = []
        self._live: LiveCommissioning | None = None

    def __enter__(self) -> Self:
        """Connect to ROS; raises the error that prevents it."""
        with ExitStack() as resources:
            self._node = resources.enter_context(replay_node(''))
            executor = resources.enter_context(SingleThreadedExecutor(context=self._node.context))
            executor.add_node(self._node)
            self._drivers = Listener(self._node)
            self._running = ThreadPoolExecutor(1).submit(self._watch, executor)
            self._resources = resources.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        """Disconnect from ROS; raises the error that ended the thread, if any."""
        self._ending.set()
        with self._resources:
            self._running.result()

    @property
    def ended(self) -> bool:
        """Whether watching has ended."""
        return self._running.done()

    def ask(self, command: Any) -> 'Future[Answer]':
        """Execute the action `do` of a command: home, undo, commission, write, apply or end."""
        answer: Future[Answer] = Future()
        answer.set_running_or_notify_cancel()  # whoever waits cannot cancel it
        self._asked.put((command, answer))
        return answer

    def _watch(self, executor: SingleThreadedExecutor) -> None:
        next_look, found = 0.0, time.monotonic() + _SEARCH
        while not self._ending.is_set():
            end = time.monotonic() + PERIOD
            while (left := end - time.monotonic()) > 0.0:
                executor.spin_once(timeout_sec=left)
            while not self._asked.empty():
                command, answer = self._asked.get()
                try:
                    self._do(command, answer)
                except ValueError as error:
                    answer.set_result(Answer(str(error), done=False))
                except Exception as error:  # noqa: BLE001, no command ends the watching
                    text = f'That failed: {type(error).__name__}: {error}'
                    answer.set_result(Answer(text, done=False))
            messages = self._drivers.poll()
            if end >= next_look:
                next_look = end + _LOOK
                self._look(Graph(self._node))
            try:
                if self._live:
                    self._live.take(messages)
                running = [gear for gear in self._gears if gear.running]
                for gear in running:
                    gear.poll()
                view = view_of(self._gear, running, looking=end < found)
            except Exception as error:  # noqa: BLE001, a message that no one expected ends nothing
                message = f'The messages cannot be shown: {type(error).__name__}: {error}'
                view = View(state='fault', tone='fail', message=message)
            if self._gear and (parameters := self._gear.parameters):
                ring = parameters.gear
                self.drawn = ring if isinstance(ring, Mechanism) else None, parameters.module
            guide = self._live.shown if self._live else None
            drivers = self._drivers.drivers()
            self.view = replace(
                view,
                drivers=tuple(map(driver_entry, drivers)),
                joints=tuple((each.topic, joint) for each in drivers for joint in each.joints),
                guide=guide,
            )

    def _look(self, graph: Graph) -> None:
        self._drivers.look(graph.drivers())
        wanted, _, actuator = self._wanted.partition(' ')
        for name in sorted({*graph.gears, wanted} - {'', *(gear.name for gear in self._gears)}):
            own = actuator if name == wanted else self._actuator
            self._gears.append(GearNode(self._node, name, own))
        for gear in [*self._gears]:
            known = {other.actuator for other in self._gears if other.name == gear.name}
            others = [GearNode(self._node, gear.name, own) for own in gear.arm if own not in known]
            self._gears += others
        # A node that starts again may have other actuators; a mistyped one is kept, as a fault.
        kept = {'', self._actuator}
        self._gears = [g for g in self._gears if not g.arm or g.actuator in {*kept, *g.arm}]
        self._gears.sort(key=_place)
        running = [gear for gear in self._gears if gear.name in graph.gears]
        going_on = self._gear if self._gear in running else None
        named = (gear for gear in self._gears if self._wanted in {gear.label, gear.name})
        asked = next(named, None)
        self._gear = asked or going_on or next(iter(running), None) or self._gear
        for gear in self._gears:
            gear.look(graph, shown=gear is self._gear)

    def _ready_gear(self, command: Mapping[str, Any]) -> GearNode:
        """Return the node; raises ValueError if none is ready, or a command answers another."""
        gear = self._gear
        if not (gear and gear.running and gear.homing.service_is_ready()):
            raise ValueError('No node is ready.')
        if command.get('revision') != gear.revision:
            new = f'{gear.name} or its parameters have changed, or it has no output'
            raise ValueError(f'Nothing was done: {new}.')
        return gear

    def _do(self, command: Any, answer: 'Future[Answer]') -> None:
        """Execute a command, and answer now or once the node has; ValueError if it is refused."""
        live, undo = self._live, self.view.undo
        match command:
            case {'do': 'home'}:
                self._ready_gear(command).home(answer)
            case {'do': 'undo'} if undo:
                gear = self._ready_gear(command)
                gear.set(gear.earlier, f'Undone: back to {undo}.', answer)
            case {'do': 'undo'}:
                raise ValueError('There is nothing to undo.')
            case {'do': 'commission', 'rotor': [_, _] as rotor, 'output': [_, _] as output}:
                self._commission(Channel(*map(str, rotor)), Channel(*map(str, output)), command)
                answer.set_result(Answer('', done=True))
            case {'do': 'write'} if live:
                start = live.write(str(command.get('actuator', '')) or self._actuator_of(live))
                answer.set_result(Answer(f'Written. Start:\n{start}', done=True))
            case {'do': 'apply'} if live:
                gear = self._ready_gear(command)
                values = live.changes(gear)
                done = f'Changed in {gear.name}: {", ".join(values) or "nothing"}'
                gear.set(values, f'{done}. Write the file to keep it after a restart.', answer)
            case {'do': 'show', 'node': str(node)} if node in {g.label for g in self._gears}:
                self._wanted = node
                self._look(Graph(self._node))
                answer.set_result(Answer('', done=True))
            case {'do': 'end'}:
                self._live = None
                answer.set_result(Answer('', done=True))
            case _:
                raise ValueError('This command is not possible now.')

    def _actuator_of(self, live: LiveCommissioning) -> str:
        """Return the actuator of the rotor, if the node of an arm hears it; else ''."""
        rotor = live.request.rotor
        arms = (gear for gear in self._gears if len(gear.arm) > 1 and gear.hears(rotor.topic))
        named = (name for gear in arms for name in gear.arm
                 if gear.arm[name].rotor_joint == rotor.joint)  # fmt: skip
        return next(named, '')

    def _commission(self, rotor: Channel, output: Channel, asked: Mapping[str, Any]) -> None:
        """Subscribe to the two joints of a request unless they are subscribed to already."""
        if rotor == output:
            raise ValueError('Choose two joints: that of the rotor and that of the output.')
        given = str(asked.get('ratio', '')).strip()
        ratio = GearRatio.parse(given) if given else None
        live = self._live
        if not live or (live.request.rotor, live.request.output) != (rotor, output):
            live = self._live = LiveCommissioning(Request(rotor=rotor, output=output))
        at_end = bool(asked.get('zero'))
        live.request = replace(live.request, ratio=ratio, zero_here='END' if at_end else None)


def _place(gear: GearNode) -> tuple[str, int]:
    """Return the place of a gear in a list: by its node, and in the order of the actuators."""
    return gear.name, [*gear.arm, gear.actuator].index(gear.actuator)
