# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
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
        """Start without segments; turns are whole within a tolerance, rad of the output."""
        self._ratio = ratio
        self._tolerance = abs(float(self._ratio)) / TURN * tolerance  # turns of the rotor
        self._segments = np.zeros(0, np.int64)  # ascending
        self._turns: Array = np.zeros(0)
        self.first = 0
        """Turns before the first segment that has an output."""
        self.changes = 0
        """Segments whose turns differ from those of the previous one."""

    def of(self, segment: Array, unknown: float = 0.0) -> Array:
        """The turns to add in segments (n,), or `unknown` where no output has told them."""
        if not len(self._segments):
            return np.full(len(segment), unknown)
        at = np.minimum(np.searchsorted(self._segments, segment), len(self._segments) - 1)
        return np.where(self._segments[at] == segment, self._turns[at], unknown)

    def learn(self, segment: Array, recorded: Array, expected: Array) -> None:
        """Learn from output angles, (n,), rad."""
        turns = (recorded - expected) * float(self._ratio) / TURN
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
