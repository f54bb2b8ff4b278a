"""Turns of a single-turn encoder that a recording does not show, taken from the outputs."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.report.document import counted
from gear_kinematics.validation.report import Finding

Array = NDArray[Any]

_MAX_SEGMENTS = 65_536
"""Segments, of which samples that still wait for their outputs are in the last few thousand."""


class UnseenTurns:
    """The turns by which recorded outputs differ from recomputed ones, segment by segment.

    Within a segment of the recording the turns are certain, so the difference is constant; see
    `RotorSamples.segment`. It is taken from the first output that differs by whole turns, and is
    0 in a segment without one.
    """

    def __init__(self, ratio: GearRatio, tolerance: float) -> None:
        """Start without segments.

        Args:
            ratio: of the gear with the encoder.
            tolerance: rad of the output, within which turns are whole.
        """
        self._ratio = ratio
        self._tolerance = abs(float(self._ratio)) / TURN * tolerance  # turns of the rotor
        self._segments = np.zeros(0, np.int64)  # ascending
        self._turns: Array = np.zeros(0)
        self.first = 0
        """Turns before the first segment that has an output."""
        self.changes = 0
        """Segments whose turns differ from those of the previous one."""

    def of(self, segment: Array, otherwise: Array | float = 0.0) -> Array:
        """The turns to add in segments (n,), or `otherwise` where they are not known."""
        if not len(self._segments):
            return np.zeros(len(segment)) + otherwise
        at = np.minimum(np.searchsorted(self._segments, segment), len(self._segments) - 1)
        return np.where(self._segments[at] == segment, self._turns[at], otherwise)

    def learn_from_angles(self, segment: Array, recorded: Array, expected: Array) -> None:
        """Learn from output angles that include whole turns, (n,), rad."""
        self._learn(segment, (recorded - expected) * float(self._ratio) / TURN)

    def learn_from_poses(self, segment: Array, recorded: Array, expected: Array) -> None:
        """Learn from output angles within their turn, (n,), rad.

        The output repeats after `numerator` turns of the rotor, and any multiple of 1/`numerator`
        of its turn corresponds to whole turns of the rotor, of which the least is taken.
        """
        steps = (recorded - expected) * self._ratio.numerator / TURN
        inverse = pow(self._ratio.denominator, -1, abs(self._ratio.numerator))
        whole = np.round(steps)
        turns = whole * inverse % abs(self._ratio.numerator)
        self._learn(segment, turns + (steps - whole) / self._ratio.denominator)

    def _learn(self, segment: Array, turns: Array) -> None:
        whole = np.round(turns)
        # Numbers too large to have a fraction are garbage.
        wrong = np.maximum(np.abs(turns - whole), np.spacing(np.abs(turns)))
        fits = (wrong <= self._tolerance) & ~np.isin(segment, self._segments)
        segments, rows = np.unique(segment[fits], return_index=True)
        if not len(segments):
            return
        found = whole[fits][rows]
        if not len(self._segments):
            self.first = int(found[0])
        before = self._turns[-1:] if len(self._turns) else found[:1]
        self.changes += int(np.count_nonzero(np.diff(found, prepend=before)))
        segments = np.append(self._segments, segments)
        latest = np.argsort(segments)[-_MAX_SEGMENTS:]  # an output can come late
        self._segments = segments[latest]
        self._turns = np.append(self._turns, found)[latest]

    def notes(self) -> Iterator[Finding]:
        """Say from where the turns were taken."""
        if self.first:
            yield Finding(
                f'the turns of the single-turn encoder before the recording, {self.first}, '
                'are taken from the outputs'
            )
        if self.changes:
            yield Finding(
                'the turns of the single-turn encoder are taken from the outputs again after '
                f'{counted(self.changes, "gap")}'
            )
