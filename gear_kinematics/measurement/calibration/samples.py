"""What the linear model needs of a recording: angles, speed, torque, states of stop operators."""

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

import numpy as np

from gear_kinematics.correction.corrector import MAX_GAP, play_bounds
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.recording import Array, Encoders, Recording

Recorded = tuple[Recording, Encoders]

_MOST = 400_000  # measured angles that are used, of all recordings; more would only take time
_SEED = 13
MOST_DRIFT = 16  # half waves of the drift of a recording's zero over its time
_MOVING = 0.05  # share of the greatest speed above which the output moves
_STROKES = 3  # strokes that tell a delay from hysteresis
_CHUNK = 4096  # turning points that are followed at a time
_SAME = 1e-9  # share of the radius by which states differ in rounding alone


def thinned(recordings: Sequence[Recorded]) -> list[Recorded]:
    """Leave out measured angles if there are very many; the rotor's motion stays as it is.

    One of each group of successive ones is chosen, at random: even steps could hide an order.
    """
    group = max(1, -(-sum(len(encoders.measured) for _, encoders in recordings) // _MOST))
    random = np.random.default_rng(_SEED)
    kept = []
    for recording, encoders in recordings:
        starts = np.arange(0, len(encoders.measured) - group + 1, group)
        rows = starts + random.integers(0, group, len(starts))
        kept.append((recording, encoders.chosen(rows)))
    return kept


class Samples:
    """The measured angles of one recording, (n,) each unless said otherwise."""

    def __init__(self, recording: Recording, encoders: Encoders, ratio: Fraction) -> None:
        self.recording, self.encoders = recording, encoders
        self.turns, self.angle = encoders.position()
        self.seconds = encoders.seconds
        self.error = encoders.error(ratio)
        self.offset = float(np.median(self.error))
        self.error -= self.offset
        self.speed = encoders.speed(ratio)
        self.torque = encoders.torque(ratio)
        ideal = encoders.ideal(ratio)
        first_output = TURN * float(encoders.rotor.turns[0]) / float(ratio)
        # Outputs of recordings count from different whole turns otherwise.
        self.output = encoders.at_measured(ideal) + first_output
        self.rotor_turns: Array = self.turns - self.turns[0] + self.angle / TURN
        self.used = np.arange(len(self.error))
        """Indices of the samples at which all stop operators are known."""
        self._points = TurningPoints(encoders, ideal, encoders.starts(MAX_GAP))
        self._stops: dict[float, tuple[Array, Array]] = {}
        moving = self.speed[np.abs(self.speed) > _MOVING * np.max(np.abs(self.speed))]
        reversals = int(np.count_nonzero(np.diff(np.sign(moving))))
        # Hysteresis depends on the direction of strokes, and not on the speed, which varies where
        # they begin and end.
        self.tells_delay = encoders.timed and 1 + reversals >= _STROKES
        """Whether an error in proportion to the speed can be told from one by hysteresis."""

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """States of the stop operator of a radius, rad, and whether they are known."""
        if radius not in self._stops:
            states, known = self._points.stop_states(radius)
            self._stops[radius] = states.astype(np.float32), known
        return self._stops[radius]

    def own_values(self, at: Array) -> Array:
        """Columns of the recording's own unknowns at some samples: zero, delay, drift."""
        speed = self.speed[at] if self.tells_delay else np.zeros(len(at))
        time = math.pi * self.seconds[at] / self.seconds[-1]
        waves = np.cos(np.multiply.outer(time, np.arange(1, MOST_DRIFT + 1)))
        return np.column_stack([np.ones(len(at)), -speed, waves])


class TurningPoints:
    """Where the rotor turns back; the play in between depends on that at the last such point."""

    def __init__(self, encoders: Encoders, ideal: Array, starts: Array) -> None:
        """Find them.

        Args:
            encoders: whose measured angles the states are for.
            ideal: output angle of the rotor's samples, rad.
            starts: indices of the rotor's samples before which the motion is unknown.
        """
        steps = np.diff(ideal)
        moving = np.flatnonzero(steps)
        back = np.diff(np.sign(steps[moving])) != 0.0
        points = np.union1d(starts, moving[1:][back])
        self._angles = ideal[points]
        self._begins = np.searchsorted(points, starts)
        self._last = np.searchsorted(points, encoders.before, side='right') - 1
        self._output = encoders.at_measured(ideal)

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """Follow a stop operator of a radius, rad.

        Returns:
            The middle between its least and greatest possible state at the measured angles, (n,),
            rad, and whether both are the same.
        """
        parts = []
        for begin, end in pairwise([*self._begins.tolist(), len(self._angles)]):
            ends = np.array([-np.inf]), np.array([np.inf])
            for first in range(begin, end, _CHUNK):
                angles = self._angles[first : min(first + _CHUNK, end)]
                parts.append(np.hstack(play_bounds(angles, np.array([radius]), *ends)))
                ends = parts[-1][-1, :1], parts[-1][-1, 1:]
        output = self._output[:, np.newaxis]
        plays = np.concatenate(parts)[self._last]
        least, most = np.clip(plays, output - radius, output + radius).T
        return self._output - 0.5 * (least + most), most - least <= _SAME * radius
