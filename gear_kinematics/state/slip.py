# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds that the output has slipped against the rotor, and remembers it."""

import statistics
from itertools import pairwise
from typing import NamedTuple

from gear_kinematics.correction.transmission_error import ErrorBlock, ErrorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.wire.cdr import SECOND


class Slip(NamedTuple):
    """A lasting movement of the output against the rotor."""

    stamp: int  # ns: the first error beyond the tolerance
    angle: float  # rad, by which the output has moved, as of the latest errors of a similar speed


class _Block(NamedTuple):
    """The median error in the middle of a block, and the range of the speeds in all of it."""

    error: float  # rad
    slowest: float  # rad/s
    fastest: float

    @property
    def speed(self) -> float:
        """The greatest speed in either direction, rad/s."""
        return max(self.fastest, -self.slowest)

    def tolerance(self, other: '_Block', parameters: NodeParameters) -> float:
        """Greatest difference between the errors of two blocks without a slip, rad.

        A delay between the encoders, which is unknown, adds an error in proportion to the speed.
        """
        apart = max(self.fastest - other.slowest, other.fastest - self.slowest)
        limit, delay = parameters.transmission_error_limit, parameters.transmission_error_max_gap
        return limit + delay * apart


class SlipWatch:
    """Compares the transmission error with that at the reference of the rotor's turns.

    The limit of the transmission error is peak to peak, and thus bounds the difference between
    two of its means. A slip stays until `restart`.
    """

    def __init__(self, parameters: NodeParameters) -> None:
        self._parameters = parameters
        self.restart()

    def restart(self) -> None:
        """Forget the slip and the reference, as the zero or the turns have changed."""
        self.slip: Slip | None = None
        self._block = ErrorBlock(self._parameters, gaps=True)
        self._reference: _Block | None = None
        self._steady: _Block | None = None
        """The first block at about the present speed, between which a delay hides little."""
        self._last: _Block | None = None

    def add(self, sample: ErrorSample) -> None:
        """Take the next error of known turns."""
        if not (errors := self._block.add(sample)):
            return
        third = len(errors) // 3
        # Of single intervals, the steps of an encoder would be changes of the speed.
        speeds = [
            b.since(a) / (b.stamp - a.stamp) * SECOND
            for a, b in pairwise(errors[:: third // 4])
            if b.stamp > a.stamp
        ]
        # The median of the middle third ignores single wrong readings.
        middle = statistics.median(each.error for each in errors[third:-third])
        block = _Block(middle, min(speeds, default=0.0), max(speeds, default=0.0))
        reference, steady, last = self._reference, self._steady, self._last
        limit, self._last = self._parameters.transmission_error_limit, block
        if not reference or not last or not steady:
            self._reference = self._steady = block
        elif self.slip:
            if reference.tolerance(block, self._parameters) <= 2.0 * limit:
                self.slip = self.slip._replace(angle=block.error - reference.error)
        elif moved := (
            self._moved(reference, block) or self._moved(last, block) or self._moved(steady, block)
        ):
            before = block.error - moved
            first = next(each for each in errors if abs(each.error - before) >= 0.5 * abs(moved))
            self.slip = Slip(first.stamp, moved)
        elif block.speed < reference.speed:
            self._reference = block  # in slow motion a delay hides less
        if steady and steady.tolerance(block, self._parameters) > 2.0 * limit:
            self._steady = block

    def _moved(self, before: _Block, block: _Block) -> float:
        """Return by how much the output has moved, rad; 0 if that is within the tolerance."""
        angle = block.error - before.error
        return angle if abs(angle) > before.tolerance(block, self._parameters) else 0.0
