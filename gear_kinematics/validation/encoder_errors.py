# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares recorded transmission errors with the recorded encoders of rotor and output.

A node publishes the error of a measured angle once it has rotor states on both sides of it. The
order of arrival decides which errors there are, and a recording does not show it. So only those
that are there are judged, modulo a turn, where no input can be missing between the two states.
"""

import math
from collections.abc import Iterator

import numpy as np

from gear_kinematics.bag import TopicMessages
from gear_kinematics.kinematics import split_turns
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number
from gear_kinematics.state.output_encoder import measured_angle
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.fields import Array, Occurrences, Window
from gear_kinematics.validation.recorder import HOLE
from gear_kinematics.validation.report import Finding
from gear_kinematics.wire.batches import decode_joint_states

_KEPT = 16_384  # samples of each kind that wait for the others
_KIND = np.dtype([('stamp', np.int64), ('angle', np.float64)])
_IDEAL = np.dtype([*_KIND.descr, ('turns', np.float64), ('count', np.float64), ('usable', bool)])


class EncoderErrors:
    """Compares the messages of `transmission_error`."""

    def __init__(self, name: str, parameters: NodeParameters, tolerance: float) -> None:
        """Start without messages of a topic; errors agree within a tolerance, rad."""
        self.name, self._parameters, self._tolerance = name, parameters, tolerance
        self.compared = 0
        self._wrong, self._greatest = Occurrences(), 0.0
        self._forget()

    def _forget(self) -> None:
        self._measured, self._errors = np.zeros(0, _KIND), np.zeros(0, _KIND)
        self._ideal = np.zeros(0, _IDEAL)

    def take(self, encoder: TopicMessages, errors: TopicMessages) -> None:
        """Process the next messages of the encoder at the output, and of the topic."""
        parameters = self._parameters
        stamps, position, _ = _positions(encoder, parameters.output_encoder_joint)
        angle = split_turns(measured_angle(parameters, position)).angle
        measured = np.rec.fromarrays([stamps, angle], _KIND)
        self._measured = np.append(self._measured, measured)[-_KEPT:]
        stamps, error, malformed = _positions(errors, parameters.output_name)
        if malformed.any():
            self._wrong.add(np.array(errors.received)[malformed])
            self._greatest = math.inf
        self._errors = np.append(self._errors, np.rec.fromarrays([stamps, error], _KIND))[-_KEPT:]

    def take_rotor(self, samples: Window, moved: Window, answered: Array) -> None:
        """Process the next samples, (n,), whether the node had them, and compare.

        `moved` are the samples as they are counted in the outputs.
        """
        turns, rest = self._parameters.gear.gear_ratio.output_angle(
            moved['turns'], moved['angle'], np
        )
        count = TURN * (moved['turns'] - samples['turns']) + moved['angle'] - samples['angle']
        usable = answered & samples['turns_known']
        new = np.rec.fromarrays([samples['stamp'], rest, turns, count, usable], _IDEAL)
        ideal = np.append(self._ideal, new)
        steps = np.diff(ideal['stamp'])
        if (steps < 0).any():  # the clock was set back: what belongs together does not show
            self._forget()
            return
        ideal = ideal[np.append(True, steps > 0)[: len(ideal)]]
        self._ideal = ideal[-_KEPT:]
        if len(ideal) > 1:
            self._compare(ideal, HOLE * float(np.median(np.diff(ideal['stamp']))))

    def _compare(self, ideal: Array, longest: float) -> None:
        due = self._errors['stamp'] <= ideal['stamp'][-1]
        errors, self._errors = self._errors[due], self._errors[~due]
        measured = self._measured[np.argsort(self._measured['stamp'], kind='stable')]
        at = np.maximum(np.searchsorted(ideal['stamp'], errors['stamp']), 1)
        before, after = ideal[at - 1], ideal[at]
        interval = after['stamp'] - before['stamp']
        longest = min(longest, self._parameters.longest_delay_ns)
        judged = before['usable'] & after['usable']
        judged &= np.abs(after['count'] - before['count']) <= self._tolerance
        judged &= (before['stamp'] <= errors['stamp']) & (interval <= longest)
        share = (errors['stamp'] - before['stamp']) / interval
        step = TURN * (after['turns'] - before['turns']) + after['angle'] - before['angle']
        expected = before['angle'] + share * step
        difference = np.full(len(errors), np.inf)
        for side in 'left', 'right':  # of equal stamps
            row = np.searchsorted(measured['stamp'], errors['stamp'], side) - (side == 'right')
            found = measured.take(row, mode='clip') if len(measured) else errors
            there = judged & (found['stamp'] == errors['stamp']) & (len(measured) > 0)
            judged &= there
            off = np.abs(errors['angle'] + expected - found['angle'])
            off = np.abs(off - TURN * np.round(off / TURN))
            difference = np.fmin(difference, off)
        wrong = judged & ~(difference <= self._tolerance)
        self.compared += int(np.count_nonzero(judged))
        self._wrong.add(errors['stamp'][wrong])
        self._greatest = max(self._greatest, float(difference[wrong].max(initial=0.0)))

    def findings(self) -> Iterator[Finding]:
        """Yield what came of it, if anything could be compared."""
        if count := self._wrong.count:
            values = {'error': number(self._greatest), 'tolerance': number(self._tolerance)}
            cause, stamp = FindingCause.ERRORS_DIFFER, self._wrong.first
            yield Finding(cause, self.name, stamp, count, values, fails=True)
        elif self.compared:
            yield Finding(FindingCause.ERRORS_AGREE, self.name, count=self.compared)


def _positions(messages: TopicMessages, joint: str) -> tuple[Array, Array, Array]:
    """Return stamps and positions of a joint, of messages with it, and which are malformed."""
    states = decode_joint_states(messages.data, joint)
    rows = states.joint_found & ~states.malformed & (states.stamp != 0)
    return states.stamp[rows], states.values[rows, 0], states.malformed
