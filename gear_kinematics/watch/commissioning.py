# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Commissions a gear live: analyses the messages of both encoders as they arrive."""

import math
import time
from collections import deque
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import numpy as np

from gear_kinematics.bag import Message, MessagesByTopic
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.commissioning.analysis import Commissioning, Request, commission
from gear_kinematics.measurement.commissioning.document import write_parameters
from gear_kinematics.measurement.gate import gated
from gear_kinematics.measurement.reading import States, as_recorded
from gear_kinematics.measurement.rotor_fields import questions
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.wording import shown
from gear_kinematics.parameters import PARAMETERS, default_config
from gear_kinematics.watch.gear import GearNode
from gear_kinematics.watch.view import Entry, Guide, Tone

_MOST_STATES = 40_000
"""20 s of both encoders at 1 kHz, analysed in 0.2 s of a processor. Of more, every second is kept,
then every fourth and so on: after five minutes, at 62 Hz, the wraps of a rotor still show."""
_PAUSE = 1.0  # s between the begins of analyses
_STROKE = TURN / 6.0  # rad, in each direction
GUIDE = 'Turn the output by hand, slowly, at least a sixth of a turn in both directions.'


class LiveCommissioning:
    """Messages of both encoders of a gear, analysed in a separate thread."""

    def __init__(self, request: Request) -> None:
        """Start with a request; its ratio can be replaced at any time."""
        self.request, self.shown = request, Guide(GUIDE)
        self._topics = request.rotor.topic, request.output.topic
        parameters = as_recorded(request.rotor.joint, request.output.joint)
        self._rotor = deque[Message](maxlen=_MOST_STATES)
        self._states = States(*self._topics, parameters, _MOST_STATES)
        self._taken: SimpleQueue[list[Message]] = SimpleQueue()
        self._found: Commissioning | None = None  # what is shown of
        self._count, self._due = 0, 0.0
        self._pool = ThreadPoolExecutor(1)
        self._analysis = self._pool.submit(self._guide)

    def take(self, messages: Sequence[Message]) -> None:
        """Add messages of any topics, and show the result of the last analysis."""
        self._rotor.extend(message for message in messages if message[0] == self._topics[0])
        self._taken.put([message for message in messages if message[0] in self._topics])
        if time.monotonic() >= self._due and self._analysis.done():
            before, self._analysis = self._analysis, self._pool.submit(self._guide)
            self._due = time.monotonic() + _PAUSE
            self.shown, self._found = before.result()

    def result(self) -> Commissioning:
        """Analyse the messages so far; raises ValueError if there is nothing to measure.

        If a busy machine has lost messages that determine a ratio, the one shown stays, with a
        note.
        """
        result, found = self._pool.submit(self._analyse).result(), self._found
        if not result.between and found and found.between and found.request == result.request:
            later = Observation.WITH_LATER_MESSAGES(answer=result.answer)
            result = replace(found, notes=(*found.notes, later))
        data, received = [m[2] for m in self._rotor], [m[1] for m in self._rotor]
        asked = questions(
            data, received, self.request.rotor.joint, result.between, self.request.limits
        )
        return replace(result, questions=tuple(map(str, asked)))

    def _analyse(self) -> Commissioning:
        while not self._taken.empty():
            messages = self._taken.get()
            found = MessagesByTopic(self._topics, messages)
            self._states.add(*(found[topic] for topic in self._topics))
            self._count += len(messages)
        name = f'the messages of {datetime.now().astimezone():%Y-%m-%d %H:%M}'
        recording = gated(self._states.recording(Path(name), Sources(as_recorded=True)))
        return commission([recording], self.request)

    def write(self, actuator: str = '') -> str:
        """Write the parameter file into the working directory, as `write_parameters` does."""
        return write_parameters(self.result(), Path(default_config().name), actuator)

    def changes(self, gear: GearNode) -> dict[str, Any]:
        """Return the parameters that a running node has to change.

        Raises ValueError if the ratio is undetermined, the node belongs to another gear, or the
        change needs a restart.
        """
        result, parameters = self.result(), gear.parameters
        if not result.between:
            raise ValueError(str(result.answer))
        if not parameters or not all(map(gear.hears, self._topics)):
            unheard = f'{gear.name} does not listen to {" and ".join(self._topics)}'
            raise ValueError(f'{unheard}: write the file, and start a node with it.')
        changed = {name: new for name, (_, new) in result.changes(parameters).items()}
        if fixed := [f'{name} {changed[name]}' for name in changed if PARAMETERS[name].read_only]:
            needed = f'a restart is needed for {", ".join(fixed)}'
            raise ValueError(f'Nothing was changed: {needed}. Write the file and restart.')
        return changed

    def _guide(self) -> tuple[Guide, Commissioning | None]:
        """Show which values of a parameter file are known, and how to find the others."""
        try:
            result = self._analyse()
        except ValueError as error:  # there is nothing to measure yet
            nothing = Entry('heard', f'{self._count} messages', str(error))
            return Guide(GUIDE, 0.0, (nothing,)), None
        angle = result.longest.encoders.measured
        forward = float((angle - np.minimum.accumulate(angle)).max())
        backward = float((np.maximum.accumulate(angle) - angle).max())
        strokes = math.degrees(forward), math.degrees(backward)
        turned = 'the output turned {:.0f}° forward and {:.0f}° backward'.format(*strokes)
        heard = '; '.join([turned, *map(str, result.longest.recording.faults)])
        moved = [min(stroke / _STROKE, 1.0) for stroke in (forward, backward)]
        moved.append(any(v.name == 'rotor_encoder' and v.value is not None for v in result.values))
        entries = [Entry('heard', f'{self._count} messages', heard)]
        for found in result.values:
            tone: Tone = 'notable' if found.value is None else ''
            entries.append(Entry(found.name, shown(found.value), str(found.evidence), tone))
        advice = str(result.answer)
        if min(moved) < 1.0:
            told = {v.evidence.what: v.evidence for v in result.values}
            advice = str(told.get(Observation.WRAPS_UNCLEAR, GUIDE))
        known = float(np.mean([*moved, bool(result.between)]))
        return Guide(advice, known, tuple(entries)), result
