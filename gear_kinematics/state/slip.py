# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds that the output has slipped against the rotor, and remembers it."""

import statistics
from typing import NamedTuple

from gear_kinematics.correction.transmission_error import ErrorSample
from gear_kinematics.parameters import NodeParameters

_BLOCK = 20  # errors whose median counts, so that single wrong readings of an encoder do not


class Slip(NamedTuple):
    """A lasting movement of the output against the rotor."""

    stamp: int  # ns: the first error beyond the tolerance
    angle: float  # by which the measured output angle has moved, as of the latest errors, rad


class _Block(NamedTuple):
    """Medians of successive errors."""

    error: float  # rad
    speed: float  # rad/s

    def tolerance(self, other: '_Block', parameters: NodeParameters) -> float:
        """Greatest difference between the errors of two blocks without a slip, rad.

        A delay between the encoders, which is unknown, adds an error in proportion to the speed.
        """
        delay = parameters.transmission_error_max_gap
        return parameters.transmission_error_limit + delay * abs(self.speed - other.speed)


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
        self._errors: list[ErrorSample] = []
        self._reference: _Block | None = None
        self._steady: _Block | None = None
        """The first block at about the present speed, between which a delay hides little."""
        self._last: _Block | None = None

    def add(self, sample: ErrorSample) -> None:
        """Take the next error of known turns."""
        self._errors.append(sample)
        if len(self._errors) < _BLOCK:
            return
        errors, self._errors = self._errors, []
        block = _Block(
            statistics.median(each.error for each in errors),
            statistics.median(each.speed for each in errors),
        )
        reference, steady, last = self._reference, self._steady, self._last
        self._last = block
        if not reference or not last or not steady:
            self._reference = self._steady = block
        elif self.slip:
            self.slip = self.slip._replace(angle=block.error - reference.error)
        elif moved := (
            self._moved(reference, block) or self._moved(last, block) or self._moved(steady, block)
        ):
            before = block.error - moved
            first = next(each for each in errors if abs(each.error - before) >= 0.5 * abs(moved))
            self.slip = Slip(first.stamp, moved)
        elif abs(block.speed) < abs(reference.speed):
            self._reference = block  # in slow motion a delay hides less
        limit = self._parameters.transmission_error_limit
        if steady and steady.tolerance(block, self._parameters) > 2.0 * limit:
            self._steady = block

    def _moved(self, before: _Block, block: _Block) -> float:
        """Return by how much the output has moved, rad; 0 if that is within the tolerance."""
        angle = block.error - before.error
        return angle if abs(angle) > before.tolerance(block, self._parameters) else 0.0
