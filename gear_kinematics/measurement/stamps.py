# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Stamps of recorded topics from a clock that was set back."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gear_kinematics.bag import TopicMessages
from gear_kinematics.measurement.recording import Array
from gear_kinematics.wire.cdr import SECOND, header_stamp, with_stamp

_CLOCK_STEP = 20_000_000  # ns by which a clock is set back at least; it is slewed by less
_STEADY = 25  # messages before and after a step whose age is steady


class ClockStep(NamedTuple):
    """A step back of the clock during a recording."""

    received: int  # when the first message with a stamp of the new time was received, ns
    size: int  # ns
    stamp: int  # last stamp before the step, ns


class RestoredClock:
    """Restamps the messages of a topic as if its clock had never been set back.

    At a step, a stamp goes back, and from then on all messages are older on reception. A late
    message is followed by others that are not late, and after a stall of a driver or a recorder
    the stamps do not go back.
    """

    def __init__(self, of_rotor: Sequence[ClockStep] = ()) -> None:
        """Begin a topic; that of an encoder takes the steps from the rotor's, as of one clock."""
        self.steps: list[ClockStep] = []
        self._of_rotor = of_rotor

    def restored(self, messages: TopicMessages) -> tuple[Sequence[bytes], Array]:
        """Return the next n messages, and the number of steps before each, (n,)."""
        received = np.asarray(messages.received, np.int64)
        stamp = np.fromiter(map(header_stamp, messages.data), np.int64, len(messages.data))
        dated = np.flatnonzero(stamp > 0)
        self._find(stamp[dated], received[dated])
        later = np.zeros(len(stamp), np.int64)
        data = messages.data
        if self.steps:
            data = [*data]
            later += sum(received >= step.received for step in self.steps)
            sizes = np.cumsum([0, *(step.size for step in self.steps)])
            for k in dated[later[dated] > 0].tolist():
                data[k] = with_stamp(data[k], int(stamp[k] + sizes[later[k]]))
        return data, later

    def _find(self, stamp: Array, received: Array) -> None:
        age = received - stamp
        for k in np.flatnonzero(np.diff(age) > _CLOCK_STEP).tolist():
            before, after = age[max(k + 1 - _STEADY, 0) : k + 1], age[k + 1 : k + 1 + _STEADY]
            size = int(np.median(after) - np.median(before))
            periods = np.diff(stamp[max(k + 1 - _STEADY, 0) : k + 2])
            if periods[-1] > np.median(periods) - size / 2:
                continue
            if size > _CLOCK_STEP and max(np.ptp(before), np.ptp(after)) < size / 4:
                at = int(received[k + 1])
                near = (own.size for own in self._of_rotor if abs(own.received - at) < SECOND)
                self.steps.append(ClockStep(at, next(near, size), int(stamp[k])))
