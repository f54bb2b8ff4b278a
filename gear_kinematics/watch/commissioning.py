# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Commissions a gear live: hears both encoders, and says what they tell so far."""

import math
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import SimpleQueue
from threading import Thread

import numpy as np
from rclpy.node import Node

from gear_kinematics.bag import Message, by_topic
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import (
    Commissioning,
    Request,
    Value,
    commission,
)
from gear_kinematics.measurement.commissioning.file import actuator_file
from gear_kinematics.measurement.csv_files import Sources
from gear_kinematics.measurement.reading import States
from gear_kinematics.measurement.recording import Encoders, Recording
from gear_kinematics.parameters import PARAMETERS, NodeParameters, default_config
from gear_kinematics.parameters.new_config import start_command, unused_name, write_new
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.recording import Channel
from gear_kinematics.watch.view import Answer, Commission, Entry
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND

_MOST_STATES = 60_000
"""Half a minute of both encoders at 1 kHz, which are analysed in a second or two; of more, one of
every two, four, ... is kept: after five minutes, at 100 Hz, a rotor's wraps still show."""
_PERIOD = 1.0  # s between analyses, at least
_PAUSE = 3.0  # times as long between analyses as one takes: they leave time for all else
_PATIENCE = 5.0  # s to wait for the node's answer
_STROKE = TURN / 6.0  # rad, each way
GUIDE = 'Turn the output by hand, slowly, at least a sixth of a turn both ways.'


class LiveCommissioning:
    """Hears both encoders of a gear.

    Messages are taken in `poll`, by the thread to which the node belongs, and analysed in another,
    so that the queues of the middleware do not overflow meanwhile.
    """

    def __init__(self, node: Node, request: Request, *, once: bool = False) -> None:
        """Subscribe to the topics of a request; its ratio can be replaced at any time.

        With `once`, the first result with all that is needed is kept.
        """
        self.request, self._once = request, once
        self.collected: tuple[Recording, Encoders] | None = None
        self.result: Commissioning | None = None
        self.fault = ''  # why there is no result
        self._zero_here = 0  # ns
        self._topics = request.rotor.topic, request.output.topic
        self._channels = {name: Channel(node, name, topics.JOINT_STATE) for name in self._topics}
        rotor, output = request.rotor.joint, request.output.joint
        parameters = replace(NodeParameters.load(), rotor_joint=rotor, output_encoder_joint=output)
        self._states = States(*self._topics, parameters, _MOST_STATES)
        self._queue: SimpleQueue[list[Message] | None] = SimpleQueue()
        self._thread = Thread(target=self._run)
        self._thread.start()

    def poll(self) -> None:
        """Take what has come."""
        self._queue.put([m for channel in self._channels.values() for m in channel.take()])

    def zero_here(self) -> Answer:
        """Let the output angle be 0 where the output is now."""
        stamp = self._channels[self._topics[1]].stamp
        self._zero_here = stamp if stamp > 0 else time.time_ns()
        return Answer('The output angle is 0 here.', done=True)

    def close(self) -> None:
        """Unsubscribe; the analysis ends by itself."""
        for channel in self._channels.values():
            channel.source.close()
        self._queue.put(None)

    def finish(self) -> None:
        """Analyse, after `close`, all that has come, unless nothing more is needed."""
        self._thread.join()
        if self.shown().known < 1.0:
            self._analyse([])

    def _run(self) -> None:
        due = time.monotonic() + _PERIOD
        while (messages := self._queue.get()) is not None:
            began = time.monotonic()
            if self._once and self.shown().known == 1.0:
                continue
            self._analyse(messages, only_add=began < due)
            if began >= due:
                due = began + max(_PERIOD, _PAUSE * (time.monotonic() - began))

    def _analyse(self, messages: list[Message], *, only_add: bool = False) -> None:
        try:
            found = by_topic(messages, self._topics)
            self._states.add(*(found[topic] for topic in self._topics))
            if only_add:
                return
            now = datetime.now().astimezone()
            recording = self._states.recording(Path(f'live on {now:%Y-%m-%d at %H:%M}'), Sources())
            assert recording.encoders  # noqa: S101, there is a topic of the output
            if self._zero_here:
                zero = (self._zero_here - int(recording.encoders.rotor.stamp[0])) / SECOND
                self.request, self._zero_here = replace(self.request, zero_here=zero), 0
            self.collected = recording, recording.encoders
            self.result = commission([self.collected], self.request)
        except ValueError as error:  # there is nothing to measure yet
            self.result, self.fault = None, str(error)
        except Exception as error:  # noqa: BLE001, messages that no one expected end nothing
            self.result, self.fault = None, f'{type(error).__name__}: {error}'

    def shown(self) -> Commission:
        """What there is to see."""
        result, channels = self.result, self._channels.values()
        count, lost = sum(c.count for c in channels), sum(c.losses.missing for c in channels)
        heard = f'{self.request.rotor.joint} (rotor) and {self.request.output.joint} (output): '
        heard += f'{count} messages, {lost} lost'
        if not result:
            return Commission(f'{heard}; {self.fault}' if self.fault else heard, GUIDE)
        ways = _ways(result)
        turned = [min(way / _STROKE, 1.0) for way in ways]
        kind = any(value.name == 'rotor_encoder' for value in result.values)
        known = float(np.mean([*turned, result.between is not None, kind]))
        advice, ratio = GUIDE, result.ratio
        if known == 1.0:
            advice = f'All is known that is needed: {result.answer}'
        elif min(turned) == 1.0:
            advice = result.fault or 'Go on: turn the rotor by more than a turn.'
            if ratio and ratio.advice and not self.request.ratio:
                advice = f'Go on: {ratio.advice}, or give the ratio on the nameplate.'
        heard += '; the output turned {:.0f}° on and {:.0f}° back'.format(*map(math.degrees, ways))
        entries = [
            Entry(
                v.name,
                f'{v.value:.6g}' if isinstance(v.value, float) else str(v.value),
                v.evidence,
            )
            for v in result.values
        ]
        for left in result.open:
            so_far = ratio.plus_minus if ratio and left.what == 'ratio' else 'open'
            entries.append(Entry(left.what, so_far, f'{left.known}; {left.advice}', 'notable'))
        return Commission(heard, advice, known, tuple(entries))

    def write(self) -> Answer:
        """Write the parameter file to a new name in the working directory."""
        result, path = self._known(), unused_name(Path(), default_config().name)
        write_new(path, actuator_file(result, path.name))
        command = start_command(self._topics[0], path.name, self._topics[1])
        return Answer(f'{path} is written. Start:', done=True, command=command)

    def take(self, gear: GearNode | None, answer: 'Future[Answer]') -> Callable[[], bool]:
        """Set in the node what can change while it runs; returns whether the answer is pending."""
        result, (rotor, output) = self._known(), self._topics
        if not (gear and gear.running and gear.gear and gear.parameters):
            raise ValueError('There is no node: write the file, and start one.')
        if not {rotor, output} <= set(gear.heard) or gear.inputs.get(topics.ROTOR_STATE) == output:
            what = f'{rotor} as {topics.ROTOR_STATE} and {output} as {topics.OUTPUT_ENCODER}'
            raise ValueError(f'{gear.name} does not hear {what}: write the file, and start it.')
        live = {v.name: v.value for v in result.values if not PARAMETERS[v.name].read_only}
        has = gear.parameters.values() | {'gear_ratio': str(gear.gear.gear_ratio)}
        fixed = [v for v in result.values if v.name not in live and has[v.name] != v.value]
        words = f'{gear.name} has taken {", ".join(live)}'
        asked, deadline = gear.set(live), time.monotonic() + _PATIENCE

        def pending() -> bool:
            if asked.done():
                gear.reread()
                outcome = asked.result().result
                told = Answer(outcome.reason, done=False)
                if outcome.successful:
                    told = self._restart(words, fixed)
                answer.set_result(told)
            elif time.monotonic() > deadline:
                answer.set_result(Answer('The node does not answer.', done=False))
            return not answer.done()

        return pending

    def _restart(self, words: str, fixed: list[Value]) -> Answer:
        if not fixed:
            return Answer(f'{words}, until it ends; the file keeps them.', done=True)
        try:
            written = self.write()
        except ValueError as error:
            written = Answer(str(error), done=False)
        needed = ', '.join(f'{value.name} {value.value}' for value in fixed)
        text = f'{words}. {needed} needs a restart: {written.text}'
        return written._replace(text=text)

    def _known(self) -> Commissioning:
        if not self.result or self.result.fault:
            known = self.result.fault if self.result else self.fault
            raise ValueError(known or 'Nothing has been heard yet.')
        return self.result


def begin(
    live: LiveCommissioning | None, node: Node, request: Request, ratio: str
) -> LiveCommissioning:
    """Hear two joints; if these are heard already, only the ratio is another one."""
    request = replace(request, ratio=GearRatio.parse(ratio) if ratio else None)
    if request.rotor == request.output:
        raise ValueError('Choose two joints: that of the rotor and that of the output.')
    if live and (live.request.rotor, live.request.output) == (request.rotor, request.output):
        live.request = replace(live.request, ratio=request.ratio)
        return live
    if live:
        live.close()
    return LiveCommissioning(node, request)


def _ways(result: Commissioning) -> tuple[float, float]:
    """The greatest angles by which the output turned on, and back, rad."""
    angle = result.longest.encoders.measured
    on, back = angle - np.minimum.accumulate(angle), np.maximum.accumulate(angle) - angle
    return float(on.max()), float(back.max())
