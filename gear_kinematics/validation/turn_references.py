# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges the turns, or the zero, that the output encoder gave a node, by the recorded encoder.

At which sample the rotor's count was referenced is taken from the outputs, as a recorder does not
see the order of arrival in the node; to what, is computed from the recorded encoder.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from operator import itemgetter

from gear_kinematics.bag import TopicMessages
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import counted, number
from gear_kinematics.state.referenced_input import ReferencedInput
from gear_kinematics.validation.count_changes import Change, CountChanges, LastOutput
from gear_kinematics.validation.fields import Array
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.cdr import SECOND

_PATIENCE = SECOND  # ns after the own decision by which a node must have come to the same


@dataclass(slots=True)
class _Segment:
    """What the recorded encoder gives in a segment of the recorded rotor."""

    turns: float = 0.0
    angle: float = 0.0
    """rad: the rotor angle is 2π turns + angle more than counted."""
    since: int | None = None
    """Stamp of the first sample that is referenced."""
    uncertainty: float = 0.0
    """rad, of the output angle."""


class TurnReferences:
    """References each segment as the node does, and compares it with that of the outputs."""

    def __init__(self, parameters: NodeParameters, calibration: Calibration | None) -> None:
        self._input = ReferencedInput(parameters, calibration)
        self._single_turn, self._ratio = parameters.single_turn, parameters.gear.gear_ratio
        self._segments: dict[int, _Segment] = {}
        self._encoder_messages = 0

    def take(self, rotor: TopicMessages, encoder: TopicMessages, samples: Array) -> None:
        """Process the next messages; `samples`, (n,), are those of the rotor as counted."""
        self._encoder_messages += len(encoder.data)
        arrivals = [
            (topic is rotor, *each)
            for topic in (rotor, encoder)
            for each in zip(topic.received, topic.data, strict=True)
        ]
        arrivals.sort(key=itemgetter(1))
        columns = (samples[name].tolist() for name in ('segment', 'turns', 'angle'))
        for (row, _), segment, turns, angle in zip(
            self._input.take(arrivals), *columns, strict=True
        ):
            own, stamp = self._segments.setdefault(segment, _Segment()), row[0]
            own.turns, own.angle = row[1] - turns, row[2] - angle
            if self._input.rotor.referenced:
                own.since = own.since or stamp
                own.uncertainty = self._input.reference.uncertainty or 0.0

    def findings(self, changes: CountChanges) -> Iterator[Finding]:
        """Judge the references that the outputs show."""
        changes_in = defaultdict[int, list[Change]](list)
        for change in changes.found:
            if not change.homed:
                changes_in[change.segment].append(change)
        agreed = 0
        for segment, last in changes.last_outputs.items():
            own, found = self._segments.get(segment, _Segment()), changes_in[segment]
            fault = self._fault(own, found, last)
            agreed += own.since is not None and not fault
            unjudged = ', which is not judged: the recorded output_encoder gives none'
            if fault or (found and own.since is None):
                moved = self._written(last.turns, last.angle)
                yield Finding(
                    f'the outputs are moved by {moved}{fault or unjudged}',
                    fails=bool(fault),
                    stamp=found[-1].stamp if found else own.since,
                    when='from',
                )
        if agreed:
            times = counted(agreed, 'time')
            yield Finding(f'the outputs are referenced as output_encoder gives it, {times}')
        elif not self._encoder_messages:
            yield Finding('the reference is not judged: no output_encoder is recorded')

    def _fault(self, own: _Segment, changes: Sequence[Change], last: LastOutput) -> str:
        """What is wrong with the changes in a segment, or with none in it; '' if nothing."""
        if len(changes) > 1:
            return ', again without a gap'
        if changes and not self._single_turn and changes[0].number == last.number:
            return ' in the last one alone'  # any other angle would be explained
        if own.since is not None:
            if self._agree(last.turns - own.turns, last.angle - own.angle, own):
                return ''
            if changes or last.stamp - own.since > _PATIENCE:
                given = self._written(own.turns, own.angle)
                return f', but the recorded output_encoder gives {given}'
        return ''

    def _agree(self, turns: float, angle: float, own: _Segment) -> bool:
        """Whether a rotor angle of 2π turns + angle is none, as far as an encoder can tell."""
        if self._single_turn:
            return round(turns + angle / TURN) % abs(self._ratio.numerator) == 0
        output = (TURN * turns + angle) / float(self._ratio)
        return abs(math.remainder(output, TURN)) <= own.uncertainty

    def _written(self, turns: float, angle: float) -> str:
        if self._single_turn:
            return f'{turns + angle / TURN:+.6g} turns of the rotor'
        return f'{number((TURN * turns + angle) / float(self._ratio) + 0.0)} rad'
