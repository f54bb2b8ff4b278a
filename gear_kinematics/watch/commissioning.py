# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Commissions a gear live: hears both encoders, and says what they tell so far."""

import math
import time
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import Any

import numpy as np
from rclpy.node import Node
from rclpy.qos import ReliabilityPolicy

from gear_kinematics.bag import Message, by_topic
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import Commissioning, Request, commission
from gear_kinematics.measurement.commissioning.file import actuator_file
from gear_kinematics.measurement.csv_files import Sources
from gear_kinematics.measurement.reading import States
from gear_kinematics.measurement.recording import Encoders, Recording
from gear_kinematics.parameters import PARAMETERS, NodeParameters, default_config
from gear_kinematics.parameters.new_config import start_command, write_new
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.polled import Polled
from gear_kinematics.watch.view import Answer, Commission, Entry, shown
from gear_kinematics.wire import topics
from gear_kinematics.wire.cdr import SECOND, header_stamp

_MOST_STATES = 40_000
"""20 s of both encoders at 1 kHz, analysed in 0.2 s of a processor; of more, one of every two,
four, ... is kept: after five minutes, at 62 Hz, a rotor's wraps still show."""
_PAUSE = 1.0  # s between analyses: they leave time for all else
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
        self.fault = 'Nothing has been heard yet.'  # why there is no file
        self.shown = Commission('', GUIDE)
        self._topics = request.rotor.topic, request.output.topic
        reliability = ReliabilityPolicy.BEST_AVAILABLE
        self._heard = {
            topic: Polled(node, topic, reliability=reliability) for topic in self._topics
        }
        rotor, output = request.rotor.joint, request.output.joint
        parameters = replace(NodeParameters.load(), rotor_joint=rotor, output_encoder_joint=output)
        self._states = States(*self._topics, parameters, _MOST_STATES)
        self._queue: SimpleQueue[list[Message] | None] = SimpleQueue()
        self._thread = Thread(target=self._run)
        self._thread.start()

    def poll(self) -> None:
        """Take what has come."""
        self._queue.put(
            [
                (topic, received, data)
                for topic, heard in self._heard.items()
                for data, received in heard.take()
            ]
        )

    def zero_here(self) -> Answer:
        """Let the output angle be 0 where the output is now."""
        if not self.collected:
            return Answer(self.fault, done=False)
        last = self._heard[self._topics[1]].last
        stamp = header_stamp(last.data) if last else 0
        now = stamp if stamp > 0 else time.time_ns()
        self.request = replace(self.request, zero_here=now / SECOND)
        return Answer('The output angle is 0 here.', done=True)

    def close(self) -> None:
        """Unsubscribe; the analysis ends by itself."""
        for heard in self._heard.values():
            heard.close()
        self._queue.put(None)

    def finish(self) -> None:
        """Analyse, after `close`, all that has come, unless nothing more is needed."""
        self._thread.join()
        if not self._enough():
            self._analyse()

    def _run(self) -> None:
        due = time.monotonic() + _PAUSE
        while (messages := self._queue.get()) is not None:
            if self._once and self._enough():
                continue
            found = by_topic(messages, self._topics)
            self._states.add(*(found[topic] for topic in self._topics))
            if time.monotonic() >= due:
                self._analyse()
                due = time.monotonic() + _PAUSE

    def _enough(self) -> bool:
        """Whether the result has all that is needed, and is what is asked for by now."""
        return bool(self.result and self.result.request == self.request and self.shown.known == 1)

    def _analyse(self) -> None:
        now, request = datetime.now().astimezone(), self.request
        try:
            recording = self._states.recording(Path(f'live on {now:%Y-%m-%d at %H:%M}'), Sources())
            assert recording.encoders  # noqa: S101, there is a topic of the output
            self.collected = recording, recording.encoders
            self.result = commission([self.collected], request)
            self.fault = self.result.fault
        except ValueError as error:  # there is nothing to measure yet
            self.result, self.fault = None, str(error)
        except Exception as error:  # noqa: BLE001, messages that no one expected end nothing
            self.result, self.fault = None, f'{type(error).__name__}: {error}'
        channels = self._heard.values()
        count, lost = sum(c.count for c in channels), sum(c.losses.missing for c in channels)
        heard = f'{request.rotor.joint} (rotor) and {request.output.joint} (output): '
        heard += f'{count} messages, {lost} lost; '
        if self.result:
            self.shown = _progress(self.result, heard)
        else:
            self.shown = Commission(heard + self.fault, GUIDE)

    def write(self) -> Answer:
        """Write the parameter file into the working directory; it replaces nothing."""
        name, (rotor, output) = default_config().name, self._topics
        write_new(Path(name), actuator_file(self._known(), name))
        command = start_command(rotor, name, output)
        return Answer(f'{name} is written. Start:\n{command}', done=True)

    def changes(self, gear: GearNode) -> dict[str, Any]:
        """Return what a running node has to change.

        Raises:
            ValueError: if it is none of this gear, or only a restart changes all of it: a part
                would fit neither gear.
        """
        result, (rotor, output) = self._known(), self._topics
        if not (gear.gear and gear.parameters and gear.hears(rotor) and gear.hears(output)):
            what = f'{rotor} as {topics.ROTOR_STATE} and {output} as {topics.OUTPUT_ENCODER}'
            raise ValueError(f'{gear.name} does not hear {what}: write the file, and start it.')
        has = gear.parameters.values() | {'gear_ratio': str(gear.gear.gear_ratio)}
        changed = {v.name: v.value for v in result.values if has[v.name] != v.value}
        if fixed := [f'{name} {changed[name]}' for name in changed if PARAMETERS[name].read_only]:
            needed = f'{", ".join(fixed)} needs a restart'
            raise ValueError(f'Nothing is changed: {needed}; write the file, and start it.')
        if not changed:
            raise ValueError(f'{gear.name} has these parameters already.')
        return changed

    def _known(self) -> Commissioning:
        if not self.result or self.fault:
            raise ValueError(self.fault)
        if self.result.request != self.request:
            raise ValueError('The change is not analysed yet: try again in a second.')
        return self.result


def _progress(result: Commissioning, heard: str) -> Commission:
    """Show how much is known of what a parameter file needs, and what to do for the rest."""
    angle, ratio = result.longest.encoders.measured, result.ratio
    on, back = angle - np.minimum.accumulate(angle), np.maximum.accumulate(angle) - angle
    ways = float(on.max()), float(back.max())
    heard += 'the output turned {:.0f}° on and {:.0f}° back'.format(*map(math.degrees, ways))
    turned = [min(way / _STROKE, 1.0) for way in ways]
    kind = any(value.name == 'rotor_encoder' for value in result.values)
    known = float(np.mean([*turned, result.between is not None, kind]))
    advice = GUIDE
    if known == 1.0:
        advice = f'All is known that is needed: {result.answer}'
    elif ratio and ratio.advice and not result.request.ratio:
        advice = f'Go on: {ratio.advice}, or give the ratio on the nameplate.'
    elif min(turned) == 1.0:
        advice = result.fault or 'Go on: turn the rotor by more than a turn.'
    entries = [Entry(v.name, shown(v.value), v.evidence) for v in result.values]
    for left in result.open:
        so_far = ratio.plus_minus if ratio and left.what == 'ratio' else 'open'
        entries.append(Entry(left.what, so_far, f'{left.known}; {left.advice}', 'notable'))
    return Commission(heard, advice, known, tuple(entries))
