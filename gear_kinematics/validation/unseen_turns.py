"""Whole turns that a single-turn encoder made before a recording or in its gaps."""

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN

Array = NDArray[np.float64]
Stretches = NDArray[np.int64]

_KEPT = 65_536
"""Stretches, of which samples that still wait for their outputs are in the last few thousand."""


class UnseenTurns:
    """The turns by which recorded outputs differ from recomputed ones, stretch by stretch.

    Within a stretch of the recording the turns are counted without a doubt, so that they differ
    by the same number; see `RotorSamples.stretch`. The first output that differs by whole turns
    tells it. A stretch without any counts as not different.
    """

    def __init__(self, mechanism: Mechanism, tolerance: float) -> None:
        """Start with no stretch.

        Args:
            mechanism: that the encoder is at the rotor of.
            tolerance: rad of the output, within which turns are whole.
        """
        self._ratio = mechanism.gear_ratio
        self._tolerance = abs(float(self._ratio)) / TURN * tolerance  # turns of the rotor
        self._stretches = np.zeros(0, np.int64)  # ascending
        self._turns = np.zeros(0)
        self.first = 0
        """Turns before the first stretch that has an output."""
        self.changes = 0
        """How often the turns differed from those of the stretch before."""

    def of(self, stretch: Stretches, otherwise: Array | float = 0.0) -> Array:
        """The turns to add in stretches (n,), and something else where they are not known."""
        if not len(self._stretches):
            return np.zeros(len(stretch)) + otherwise
        at = np.minimum(np.searchsorted(self._stretches, stretch), len(self._stretches) - 1)
        return np.where(self._stretches[at] == stretch, self._turns[at], otherwise)

    def learn_from_angles(self, stretch: Stretches, recorded: Array, expected: Array) -> None:
        """Learn from output angles that count turns, (n,), rad."""
        self._learn(stretch, (recorded - expected) * float(self._ratio) / TURN)

    def learn_from_poses(self, stretch: Stretches, recorded: Array, expected: Array) -> None:
        """Learn from output angles within their turn, (n,), rad.

        The output is back where it was after `numerator` turns of the rotor, and an angle of
        1/`numerator` of its turn takes the rotor some whole turns, of which the least is enough.
        """
        steps = (recorded - expected) * self._ratio.numerator / TURN
        inverse = pow(self._ratio.denominator, -1, abs(self._ratio.numerator))
        whole = np.round(steps)
        turns = whole * inverse % abs(self._ratio.numerator)
        self._learn(stretch, turns + (steps - whole) / self._ratio.denominator)

    def _learn(self, stretch: Stretches, turns: Array) -> None:
        whole = np.round(turns)
        # Numbers so large that they have no fraction are garbage, whole or not.
        wrong = np.maximum(np.abs(turns - whole), np.spacing(np.abs(turns)))
        fits = (wrong <= self._tolerance) & ~np.isin(stretch, self._stretches)
        stretches, rows = np.unique(stretch[fits], return_index=True)
        if not len(stretches):
            return
        found = whole[fits][rows]
        if not len(self._stretches):
            self.first = int(found[0])
        before = self._turns[-1:] if len(self._turns) else found[:1]
        self.changes += int(np.count_nonzero(np.diff(found, prepend=before)))
        stretches = np.append(self._stretches, stretches)
        latest = np.argsort(stretches)[-_KEPT:]  # an output can come late
        self._stretches = stretches[latest]
        self._turns = np.append(self._turns, found)[latest]

    def findings(self) -> list[str]:
        """Say what was learned, in sentences."""
        said = []
        if self.first:
            said.append(
                f'the turns of the single-turn encoder before the recording, {self.first}, '
                'are taken from the outputs'
            )
        if self.changes:
            said.append(
                'the turns of the single-turn encoder are taken from the outputs again after '
                f'{self.changes} gap{"s" * (self.changes > 1)}'
            )
        return said
