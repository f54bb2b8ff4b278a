"""The samples of all recordings, and the columns of the linear model at them."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from gear_kinematics.calibration.normal import Array, Block
from gear_kinematics.calibration.recording import Recording
from gear_kinematics.calibration.stops import TurningPoints
from gear_kinematics.calibration.terms import OrderTerm, RatioTerm, StopTerm, Term, TorqueTerm
from gear_kinematics.state.correction import MAX_GAP

MOST_DRIFT = 16
"""Cosines over the time of a recording, of 1, 2, ... half waves, for the drift of its zero."""
_BLOCKS = 24
"""Blocks of all recordings together."""
_SEVERAL = 3
"""Recordings from which on a whole one is left out at a time, not a block."""


class Samples:
    """What the model needs of one recording, (n,) each unless said otherwise."""

    def __init__(self, recording: Recording, ratio: Fraction) -> None:
        self.recording = recording
        self.turns, self.angle = recording.position()
        self.seconds = recording.seconds
        self.error = recording.error(ratio)
        self.offset = float(np.median(self.error))
        self.error -= self.offset
        self.speed = recording.speed(ratio)
        self.torque = recording.torque(ratio)
        ideal = recording.ideal(ratio)
        self.output = recording.at_measured(ideal)
        """From the whole turns of the first sample."""
        first = recording.rotor.turns[0] * (ratio.denominator / ratio.numerator)
        self.first_output = 2.0 * math.pi * float(first)
        starts = recording.starts(MAX_GAP)
        self._points = TurningPoints(recording, ideal, starts)
        self.used = np.arange(len(self.error))
        """Indices of the samples at which all stop operators are known."""
        self.stops: dict[float, Array] = {}
        self.known: dict[float, Array] = {}

    def follow(self, radius: float) -> None:
        """Follow the stop operator of a radius, unless this has been done."""
        if radius not in self.stops:
            states, self.known[radius] = self._points.stop_states(radius)
            self.stops[radius] = states.astype(np.float32)

    @property
    def rotor_turns(self) -> Array:
        """Rotor angle, turns, from that of the first sample."""
        turns: Array = self.turns - self.turns[0] + self.angle / (2.0 * math.pi)
        return turns


class Model:
    """The columns of terms, then those of the recordings' own unknowns, then the error."""

    def __init__(self, samples: Sequence[Samples], terms: Sequence[Term]) -> None:
        """Collect the terms.

        Args:
            samples: of the recordings.
            terms: whose coefficients are common to all recordings.
        """
        self.samples = samples
        self.terms = terms
        self.common = sum(term.columns for term in terms)
        """Number of columns of the terms."""
        self.speed = 1
        """Place of the speed among the own unknowns, of which the zero is the first."""
        self.drift = range(2, 2 + MOST_DRIFT)
        """Places of cosines over time."""

    def columns(self, recording: int, rows: slice) -> Array:
        """Columns (common, own, error) of used samples of a recording, (rows, size)."""
        samples = self.samples[recording]
        at = samples.used[rows]
        parts = [term_values(term, samples, at) for term in self.terms]
        return np.column_stack([*parts, self.own_values(samples, at), samples.error[at]])

    def own_values(self, samples: Samples, at: Array) -> Array:
        """Columns of a recording's own unknowns: zero, speed, drift."""
        speed = samples.speed[at] if samples.recording.separate else np.zeros(len(at))
        time = math.pi * samples.seconds[at] / samples.seconds[-1]
        waves = np.cos(np.multiply.outer(time, np.arange(1, MOST_DRIFT + 1)))
        return np.column_stack([np.ones(len(at)), speed, waves])


def term_values(term: Term, samples: Samples, at: Array) -> Array:
    """Columns of a term at some samples, (at, columns)."""
    match term:
        case OrderTerm():
            return term.values(samples.turns[at], samples.angle[at])
        case StopTerm():
            return samples.stops[term.radius][at, None] / term.radius
        case TorqueTerm():
            return (np.asarray(samples.torque)[at, None] - term.mean) / term.deviation
        case RatioTerm():
            return samples.output[at, None] / term.travel


def blocks_of(counts: Sequence[int]) -> list[Block]:
    """Divide recordings into blocks of successive samples, about as long each.

    Args:
        counts: numbers of used samples of the recordings.
    """
    total = sum(counts)
    blocks: list[Block] = []
    for recording, count in enumerate(counts):
        parts = max(2, round(_BLOCKS * count / total))
        bounds = np.linspace(0, count, parts + 1).astype(int).tolist()
        for start, stop in pairwise(bounds):
            if stop > start:
                fold = recording if len(counts) >= _SEVERAL else len(blocks)
                blocks.append(Block(recording, fold, slice(start, stop)))
    return blocks
